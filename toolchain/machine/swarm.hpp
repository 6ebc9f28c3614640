// A swarm: runs a machine and its plant under virtual time repeatedly. A seed chooses the faults of the
// devices, the components, the activities, the plant and the machine's process, and the requests of people at
// browsers. Rules judge every moment.
#pragma once

#include "kernel/services/configuration/property_files.hpp"
#include "toolchain/machine/host.hpp"
#include "toolchain/machine/swarm_browser.hpp"
#include "toolchain/machine/swarm_ports.hpp"
#include "toolchain/machine/swarm_rules.hpp"
#include "toolchain/machine/swarm_wires.hpp"

#include <array>
#include <functional>
#include <initializer_list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tappet {

/// The subject of the swarm. Without rules of its own, it is judged by the rules that hold for every machine,
/// and people may do anything; with them, people may do what its rules allow.
struct SwarmOf {
    AcceptedMachine machine;
    std::function<std::unique_ptr<Plant>(std::uint64_t seed)> plant;
    std::function<std::unique_ptr<SwarmRules>(MachineInstance&, Plant&, const Struck&)> rules;
    const AllLeftBehind* left = nullptr; ///< as SwarmRun::learn() saw it; null: not learnt
};

/// The result of one seed.
struct SwarmVerdict {
    Sentence broken{}; ///< the first broken rule, at `at`; empty: none
    Time at{};
    std::vector<std::string> before{}; ///< the last events before that
    Duration time{};                   ///< passed in the machine
    Duration back{};                   ///< from the last fault until it worked again
    std::string waited_for{};          ///< the machine's reason for not working again before its restart
    std::map<std::string, std::uint64_t> faults{}; ///< by their kinds
    std::uint64_t restarts = 0;
    std::vector<Duration> responses{}; ///< the longest of each activity, if cycles take time
    bool woken_too_often = false;      ///< an activity, more often than its row says: the analysis is void
};

/// One seed's run: the machine starts, works, is struck by overlapping faults, all of which end, works again,
/// and is stopped. Not real-time; one at a time, because a machine's memory is static.
class SwarmRun {
public:
    /// `tell`: called with each event, for a replay.
    using Tell = std::function<void(Time, std::string_view)>;
    SwarmRun(const SwarmOf& of, std::uint64_t seed, Tell tell = {});
    ~SwarmRun();
    SwarmRun(const SwarmRun&) = delete;
    SwarmRun& operator=(const SwarmRun&) = delete;
    /// Call before go(): cycles and frames take time, see VirtualRun.
    void take_times(std::uint64_t seed, can::BitRates rates) { run_.take_times(seed, rates); }
    /// Call before go(): disables all faults.
    void be_calm() { is_calm_ = true; }
    [[nodiscard]] SwarmVerdict go();
    /// Alternative to go(): learns what stopped components leave on the wires when nothing else happens.
    [[nodiscard]] AllLeftBehind learn();

private:
    /// A fault that lasts for a while.
    struct Fault {
        Time ends{};
        bool of_activity = false; ///< a whole activity is stopped, or hangs
        std::vector<std::size_t> components{};
        std::function<bool()> end{};     ///< ends it; false: not yet
        bool outlives_machine = false;   ///< a new machine has it too
        std::function<bool()> is_over{}; ///< ended by somebody else; none: impossible
    };
    /// An event to which a browser has subscribed.
    struct Watched {
        std::size_t index = nowhere;       ///< nowhere: none
        std::uint64_t before = 0;          ///< emissions that the service got before the request
        std::uint64_t lost_before = 0;     ///< losses up to the answer: the browser need not hear of them
        std::uint64_t lost_when_asked = 0; ///< losses up to the request: it may hear of later ones
        std::uint64_t told = 0, lost = 0;  ///< as the packets say
        bool was_told = false;             ///< a packet came since the last judgement
        std::uint64_t known_lost = 0;      ///< at the last judgement
        Time looked{};
        std::uint64_t owed = 0; ///< emissions that the service had at that time
    };

    bool start(bool again);
    void run_until(Time end);
    bool run_until_works(Duration limit);
    void storm(Time end);
    void strike();
    void end_faults(bool all);
    void forget(std::size_t fault);
    void forget_faults();
    void note_responses();
    void stop();
    void restart(bool orderly);
    void let_guardian_act();
    void leave();
    void rest(Duration time);
    bool mend(Duration limit);
    void judge(Time now);
    void judge_emissions();
    void deny(const Sentence& why);
    void say(std::string_view text);
    void begin(std::string_view kind, Sentence text, Duration lasts, std::vector<std::size_t> components,
               std::function<bool()> end);
    void strike_device(std::string_view device, Duration lasts);
    void strike_component(Duration lasts);
    void strike_activity(Duration lasts);
    void hang(std::size_t activity, Duration lasts);

    // swarm_people.cpp
    void find_what_people_may();
    void hear();
    void watch();
    void judge_watched();
    void ask(std::string request, SwarmBrowser::Then then);
    void set(const std::string& name, const std::string& value, std::function<void(bool)> then);
    /// Retries a request until it is accepted, as the end of a fault.
    [[nodiscard]] static std::function<bool()>
    until_accepted(std::function<void(std::function<void(bool)> then)> asks);
    void ask_for(std::string request, std::string_view refusals);
    [[nodiscard]] std::string draw(const TypeTag& type, Range range);
    void strike_people(Duration lasts);
    void strike_property(Duration lasts);
    void strike_port(Duration lasts);
    void strike_slot();
    void ask_a_command();
    void ask_to_read();
    void ask_to_save();
    void judge_saved(bool with_values);
    [[nodiscard]] std::map<std::string, std::string> kept_values();
    void judge_kept();
    void judge_forces();
    // swarm_anyone.cpp
    void strike_as_anyone(Duration lasts);
    void ask_anything(std::size_t component, Duration lasts);
    void call_anything(std::size_t component);
    void stop_a_part(std::size_t component, Duration lasts);
    void flood();
    void ask_who_hangs(std::size_t component);
    void insist(const std::string& line, unsigned times);
    void load_anything();
    [[nodiscard]] bool sends_command(std::string_view line) const;
    void anyone_asks(SwarmBrowser& by, std::string request, const SwarmBrowser::Then& then = {});
    void execute(const std::string& line, std::optional<unsigned> begun_before = {});
    [[nodiscard]] std::string any_state();
    void ask_of_lower_role(SwarmBrowser& by);
    void judge_shown(const std::string& name, std::string_view answer);
    [[nodiscard]] std::string name_of(End end) const;
    [[nodiscard]] End any_of(std::initializer_list<FacetKind> kinds, std::size_t component);
    [[nodiscard]] std::optional<std::string> any_arguments(const Facet& facet, std::string_view between);
    [[nodiscard]] std::string any_call(End end);
    [[nodiscard]] std::string any_line(std::size_t component);
    [[nodiscard]] std::string any_script(const BehaviourRow& row);
    [[nodiscard]] std::vector<std::size_t> components_on(std::string_view device) const;
    [[nodiscard]] std::vector<std::size_t> components_of(std::size_t activity) const;
    [[nodiscard]] bool chance(unsigned percent) { return random_.below(100) < percent; }

    SwarmOf of_;
    bool anything_goes_; ///< people may do anything: the machine has no rules that allow less
    Board board_;        ///< the machine's, which knows visitors
    Tell tell_;
    Random random_;
    std::string directory_; ///< this run's own: properties files, and the socket
    std::unique_ptr<Plant> plant_;
    VirtualRun run_;
    Struck struck_;
    SwarmWires wires_;
    SwarmPorts ports_;
    std::unique_ptr<SwarmRules> rules_;
    std::vector<Fault> faults_{};
    std::vector<std::size_t> drivers_{}; ///< the components that drive devices
    bool is_calm_ = false;
    bool only_people_;          ///< no other faults: people's requests are judged more strictly
    std::size_t busy_with_ = 0; ///< a component that somebody calls repeatedly
    Time busy_until_{};
    std::uint64_t lost_ = 0; ///< emissions lost so far
    std::unique_ptr<PropertyFiles> files_;
    SwarmBrowser browser_;                     ///< an engineer's
    std::array<SwarmBrowser, 6> visitors_;     ///< an operator's, and observers'
    std::size_t service_ = nowhere;            ///< the component that answers browsers
    std::vector<End> commands_{}, readable_{}; ///< that operators may send and call; that anybody may read
    std::vector<std::size_t> events_{};        ///< that can be watched, as the plan's subscriptions
    Watched watched_{};
    Time asked_by_others_until_{}; ///< requests of earlier browsers may still hold places
    std::map<std::string, std::string> first_values_{}; ///< of properties, before anybody set them
    /// The last value set to a property of this machine, with its order; empty: unknown.
    struct SetValue {
        std::uint64_t order = 0;
        std::string value{};
    };
    std::map<std::string, SetValue> set_values_{};
    std::map<std::string, std::string>
        kept_{}; ///< of properties in files, at the orderly halt before this start
    std::uint64_t sets_ = 0, sets_open_ = 0; ///< sets requested; of these not answered yet
    bool sends_script_ = false;
    bool is_gone_ = false;    ///< the machine's process
    Sentence refusal_{};      ///< the last reason why a part did not start again
    std::string last_call_{}; ///< last call by anyone
    /// The interpreter's lines, as engineers know them.
    struct Lines {
        unsigned at_work = 0;       ///< engineers' lines at work
        unsigned begun = 0;         ///< engineers' lines begun
        bool left_commands = false; ///< engineers' lines may have left commands
        bool of_peers = false;      ///< lines of peers whose role is unknown
        bool was_connected = false; ///< to this machine
    };
    Lines lines_{};
    SwarmVerdict verdict_{};
};

/// Returns each activity's worst response by the table's analysis; zero for those that are not real-time.
[[nodiscard]] std::vector<Duration> analysed_responses(const AcceptedMachine& machine);

/// The program of a machine's swarm. Exit code: 0 no rule was broken, 1 one was, 2 a wrong command line.
[[nodiscard]] int run_swarm(SwarmOf of, int count, char** words);

} // namespace tappet
