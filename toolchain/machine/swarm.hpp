// A swarm: a machine and its plant under virtual time, again and again, while a seed chooses what goes wrong
// with the devices, the components, the activities, the plant and the machine's process, and what people at
// browsers ask for. Rules judge every moment.
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

/// Who the swarm is about. Without rules of its own those are judged that hold of every machine, and people
/// may do anything; with them, what its rules allow.
struct SwarmOf {
    AcceptedMachine machine;
    std::function<std::unique_ptr<Plant>(std::uint64_t seed)> plant;
    std::function<std::unique_ptr<SwarmRules>(MachineInstance&, Plant&, const Struck&)> rules;
    const AllLeftBehind* left = nullptr; ///< as SwarmRun::learn() saw it; null: nobody has looked
};

/// What one seed came to.
struct SwarmVerdict {
    Sentence broken{}; ///< the first rule that was broken, at `at`; empty: none
    Time at{};
    std::vector<std::string> before{}; ///< what happened last before that
    Duration time{};                   ///< that passed in the machine
    Duration back{};                   ///< from the last fault until it worked again
    std::string waited_for{};          ///< it did not work again before its restart, and said this
    std::map<std::string, std::uint64_t> faults{}; ///< by their kinds
    std::uint64_t restarts = 0;
    std::vector<Duration> responses{}; ///< of each activity the longest, where cycles take time
    bool woken_too_often = false;      ///< an activity, than its row says: then the analysis says nothing
};

/// One seed's run: it starts, works, is struck by faults that overlap, all of which end, works again, and is
/// stopped. Not real-time; one at a time, since a machine's memory is static.
class SwarmRun {
public:
    /// `tell`: called with each thing that happens, for a replay.
    using Tell = std::function<void(Time, std::string_view)>;
    SwarmRun(const SwarmOf& of, std::uint64_t seed, Tell tell = {});
    ~SwarmRun();
    SwarmRun(const SwarmRun&) = delete;
    SwarmRun& operator=(const SwarmRun&) = delete;
    /// Before go(): cycles and frames take time, see VirtualRun.
    void take_times(std::uint64_t seed, can::BitRates rates) { run_.take_times(seed, rates); }
    /// Before go(): nothing fails.
    void be_calm() { is_calm_ = true; }
    [[nodiscard]] SwarmVerdict go();
    /// In its place: what components leave on the wires when they are stopped and nothing else happens.
    [[nodiscard]] AllLeftBehind learn();

private:
    /// What is wrong for a while.
    struct Fault {
        Time ends{};
        bool of_activity = false; ///< the whole of one stands, or hangs
        std::vector<std::size_t> components{};
        std::function<bool()> end{};     ///< false: not yet
        bool outlives_machine = false;   ///< a new one has it too
        std::function<bool()> is_over{}; ///< somebody else has ended it; none: nobody can
    };
    /// An event that a browser has subscribed to.
    struct Watched {
        std::size_t index = nowhere;       ///< nowhere: none
        std::uint64_t before = 0;          ///< emissions that came to the service before it was asked for
        std::uint64_t lost_before = 0;     ///< likewise: nobody tells them of these
        std::uint64_t lost_when_asked = 0; ///< of which they may be told
        std::uint64_t told = 0, lost = 0;  ///< as the packets say
        bool was_told = false;             ///< since it was judged last
        std::uint64_t known_lost = 0;      ///< by then
        Time looked{};
        std::uint64_t owed = 0; ///< had come by then
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
    void strike_bus(std::size_t component, Duration lasts);
    void garble_bus(std::string_view device, const can::Identifiers& map);
    void garble_server(std::string_view device, modbus::Twin& server, const modbus::SafeWrites& map);
    void strike_chip(std::size_t component, Duration lasts);
    void strike_server(std::size_t component, Duration lasts);
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
    /// As the end of a fault: asks until it is accepted.
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
    bool anything_goes_; ///< people may do anything: the machine has no rules that would allow less
    Board board_;        ///< the machine's, which knows visitors
    Tell tell_;
    Random random_;
    std::string directory_; ///< of its own: properties files, and the socket
    std::unique_ptr<Plant> plant_;
    VirtualRun run_;
    Struck struck_;
    SwarmWires wires_;
    SwarmPorts ports_;
    std::unique_ptr<SwarmRules> rules_;
    std::vector<Fault> faults_{};
    std::vector<std::size_t> drivers_{}; ///< the components that drive devices
    bool is_calm_ = false;
    bool only_people_;          ///< all else is well: what they do goes further
    std::size_t busy_with_ = 0; ///< a component that somebody calls again and again
    Time busy_until_{};
    std::uint64_t lost_ = 0; ///< emissions, so far
    std::unique_ptr<PropertyFiles> files_;
    SwarmBrowser browser_;                     ///< an engineer's
    std::array<SwarmBrowser, 6> visitors_;     ///< an operator's, and observers'
    std::size_t service_ = nowhere;            ///< the component that answers browsers
    std::vector<End> commands_{}, readable_{}; ///< that operators may send and call; that anybody may read
    std::vector<std::size_t> events_{};        ///< that can be watched, as the plan's subscriptions
    Watched watched_{};
    Time asked_by_others_until_{}; ///< requests may hold places that no browser of now waits for
    std::map<std::string, std::string> first_values_{}; ///< of properties, before anybody set them
    /// Of properties of this machine, by the order in which they were set; empty: it is not known.
    struct SetValue {
        std::uint64_t order = 0;
        std::string value{};
    };
    std::map<std::string, SetValue> set_values_{};
    std::map<std::string, std::string>
        kept_{}; ///< of properties in files, at the halt in order before this start
    std::uint64_t sets_ = 0, sets_open_ = 0; ///< asked for; of these not answered yet
    bool sends_script_ = false;
    bool is_gone_ = false;    ///< the machine's process
    Sentence refusal_{};      ///< why a part did not start again, the last
    std::string last_call_{}; ///< of anyone's
    /// Of the interpreter, as engineers know it.
    struct Lines {
        unsigned at_work = 0;       ///< theirs
        unsigned begun = 0;         ///< of theirs
        bool left_commands = false; ///< theirs may have
        bool of_peers = false;      ///< whose role is not known
        bool was_connected = false; ///< to this machine
    };
    Lines lines_{};
    SwarmVerdict verdict_{};
};

/// What the analysis of the table says of each activity; zero for those that are not real-time.
[[nodiscard]] std::vector<Duration> analysed_responses(const AcceptedMachine& machine);

/// The program of a machine's swarm. The exit code: 0 no rule was broken, 1 one was, 2 a wrong command line.
[[nodiscard]] int run_swarm(SwarmOf of, int count, char** words);

} // namespace tappet
