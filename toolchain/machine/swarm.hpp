// A swarm: a machine and its plant under virtual time, again and again, while a seed chooses what goes wrong
// with the devices, the components, the activities and the plant. Rules judge every moment.
#pragma once

#include "toolchain/machine/host.hpp"
#include "toolchain/machine/swarm_rules.hpp"

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace tappet {

/// Who the swarm is about.
struct SwarmOf {
    AcceptedMachine machine;
    std::function<std::unique_ptr<Plant>(std::uint64_t seed)> plant;
    std::function<std::unique_ptr<SwarmRules>(MachineInstance&, Plant&, const Struck&)> rules;
};

/// What one seed came to.
struct SwarmVerdict {
    Sentence broken{}; ///< the first rule that was broken, at `at`; empty: none
    Time at{};
    Duration time{};          ///< that passed in the machine
    Duration back{};          ///< from the last fault until it worked again
    std::string waited_for{}; ///< it did not work again before its restart, and said this
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
    /// Before go(): cycles and frames take time, see VirtualRun.
    void take_times(std::uint64_t seed, std::uint32_t bit_rate) { run_.take_times(seed, bit_rate); }
    /// Before go(): nothing fails.
    void be_calm() { is_calm_ = true; }
    [[nodiscard]] SwarmVerdict go();

private:
    /// What is wrong for a while.
    struct Fault {
        Time ends{};
        bool of_activity = false; ///< the whole of one stands, or hangs
        std::vector<std::size_t> components{};
        std::function<bool()> end{}; ///< false: not yet
    };

    bool start(bool again);
    void run_until(Time end);
    bool run_until_works(Duration limit);
    void storm(Time end);
    void strike();
    void end_faults(bool all);
    void forget_faults();
    void note_responses();
    void stop();
    void judge(Time now);
    void judge_emissions();
    void say(std::string_view text);
    void begin(std::string_view kind, Sentence text, Duration lasts, std::vector<std::size_t> components,
               std::function<bool()> end);
    void strike_bus(std::size_t component, Duration lasts);
    void strike_chip(std::size_t component, Duration lasts);
    void strike_server(std::size_t component, Duration lasts);
    void strike_component(Duration lasts);
    void strike_activity(Duration lasts);
    [[nodiscard]] std::vector<std::size_t> components_on(std::string_view device) const;
    [[nodiscard]] std::vector<std::size_t> components_of(std::size_t activity) const;
    [[nodiscard]] bool chance(unsigned percent) { return random_.below(100) < percent; }

    const SwarmOf& of_;
    Tell tell_;
    Random random_;
    std::unique_ptr<Plant> plant_;
    VirtualRun run_;
    Struck struck_;
    std::unique_ptr<SwarmRules> rules_;
    std::vector<Fault> faults_{};
    std::vector<std::size_t> drivers_{}; ///< the components that drive devices
    bool is_calm_ = false;
    std::uint64_t lost_ = 0; ///< emissions, so far
    Sentence refusal_{};     ///< why a part did not start again, the last
    SwarmVerdict verdict_{};
};

/// What the analysis of the table says of each activity; zero for those that are not real-time.
[[nodiscard]] std::vector<Duration> analysed_responses(const AcceptedMachine& machine);

/// The program of a machine's swarm. The exit code: 0 no rule was broken, 1 one was, 2 a wrong command line.
[[nodiscard]] int run_swarm(const SwarmOf& of, int count, char** words);

} // namespace tappet
