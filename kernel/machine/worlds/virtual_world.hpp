// The host world under virtual time: every engine and every simulated device in one thread, in an order that
// is the same in every run. Nothing sleeps: time jumps to the next thing that happens.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/base/random.hpp"
#include "kernel/machine/instance/instance.hpp"
#include "kernel/machine/worlds/virtual_loop.hpp"

#include <array>
#include <optional>

namespace tappet {

/// Something beside the machine that lives in virtual time: a plant, a twin that delays frames.
struct VirtualProcess {
    void* self = nullptr;
    Time (*next)(void* self) = nullptr;          ///< when it wants to run
    void (*run)(void* self, Time now) = nullptr; ///< moves it to now; afterwards next() is later than now
};

/// Runs an engine's cycles in the world's place: for who measures them. `run` calls engine.run(woken) once.
struct CycleRunner {
    void* self = nullptr;
    void (*run)(void* self, Engine& engine, bool woken) = nullptr;
};

class VirtualWorld {
public:
    /// The instance is configured and its clock is virtual.
    explicit VirtualWorld(MachineInstance& instance) noexcept;

    /// Before start. Processes of one instant run in the order they were added, before the engines.
    void add(const VirtualProcess& process) noexcept { static_cast<void>(processes_.push(process)); }

    /// Before start. Without one, the world itself calls Engine::run.
    void run_cycles_by(const CycleRunner& runner) noexcept { runner_ = runner; }

    /// Before start: a cycle takes time, up to its row's budget, as the seed draws it; on each processor the
    /// most urgent activity runs, and what it does is seen when its time is used up. Without this no cycle
    /// takes any.
    void take_times(std::uint64_t seed) noexcept { times_.emplace(seed); }
    /// Of cycles that take time: from the wake or the release to the end, the longest so far.
    [[nodiscard]] Duration longest_response(std::size_t activity) const noexcept {
        return jobs_[activity].longest;
    }

    /// From now on what a change of an activity runs of its components' functions (initialise, finalise)
    /// takes so long; the others go on meanwhile, and no stop waits for it. Nought: no time.
    void makers_take(Duration time) noexcept { makers_take_ = time; }

    /// Activities start in the table's order. Empty: all did; else the first refusal, and all are stopped.
    Sentence start();
    /// As RealWorld's; the others go on while it takes time.
    [[nodiscard]] Sentence change_activity(std::size_t activity, LifeChange change);
    /// Its thread does not come: the activity runs no cycle before `until`, whatever wakes it. A stop is done
    /// all the same, as if its guardian wrote the safe values. For tests of what a hang does to the others.
    void hang(std::size_t activity, Time until) noexcept {
        hangs_until_[activity] = until;
        jobs_[activity].release = std::max(jobs_[activity].release, until); // a hang is no response
    }
    /// Runs to `end`, or until a stop is asked for: then false.
    bool run_until(Time end);
    /// Engines stop, the last row of the table first; when all have, their components are finalised.
    void stop();

    /// Before this time no engine runs, no other process wants to, and run_until() does not return: for a
    /// process that may leap. None before now.
    [[nodiscard]] Time quiet_until(const void* process) const;

    /// When the next engine or process runs: for who moves several worlds by turns.
    [[nodiscard]] Time next_time() const { return quiet(nullptr, never); }

    [[nodiscard]] std::uint64_t steps() const noexcept { return steps_; }

private:
    /// Engines of one instant: a message wakes another, and so on, so many times at most.
    static constexpr int max_rounds_per_instant = 1000;

    /// A cycle that is under way.
    struct Job {
        bool is_there = false;
        bool woken = false;
        Time release{}, ended{};
        Duration left{};
        Duration longest{};
    };

    [[nodiscard]] ActivityControl control() noexcept;
    [[nodiscard]] bool is_ready(std::size_t activity, Time now);
    /// The most urgent job of a processor; nowhere: it has none.
    [[nodiscard]] std::size_t at_work(int processor) const;
    void work_until(Time now);
    void run_engine(std::size_t activity, bool woken);
    void sleep_until(std::size_t activity, Time time);
    [[nodiscard]] Time quiet(const void* but, Time end) const;
    void run_engines(Time now);
    /// Processes and engines of an instant.
    void run_instant(Time now);
    /// False: a stop was asked for.
    [[nodiscard]] bool complete_change(std::size_t activity);
    /// The others go on while the behaviours of one activity come to their ends.
    void end(std::size_t activity);

    MachineInstance& instance_;
    Bounded<VirtualProcess, 8> processes_{};
    CycleRunner runner_{};
    Bounded<std::size_t, max_activities> by_urgency_{};
    // Of each engine, by row: it changes only while that engine runs, and asking an engine costs a look at
    // all its timers.
    std::array<Time, max_activities> wake_at_{};
    std::array<Time, max_activities> hangs_until_{};
    std::optional<Random> times_{}; ///< none: cycles take no time
    std::array<Job, max_activities> jobs_{};
    Time worked_until_{};
    std::array<std::optional<VirtualLoop>, max_activities> loops_{};
    Duration makers_take_{};
    Time makers_until_ = never; ///< their functions are done then
    Time end_{};                ///< of the run
    std::uint64_t steps_ = 0;
    bool is_ending_ = false; ///< engines run although a stop was asked for
};

} // namespace tappet
