// The host world under virtual time: every engine and every simulated device in one thread, in an order that
// is the same in every run. Nothing sleeps: time jumps to the next event.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/base/random.hpp"
#include "kernel/machine/instance/instance.hpp"
#include "kernel/machine/worlds/virtual_loop.hpp"

#include <array>
#include <optional>

namespace tappet {

/// A process outside the machine that lives in virtual time: a plant, or a twin that delays frames.
struct VirtualProcess {
    void* self = nullptr;
    Time (*next)(void* self) = nullptr;          ///< when it wants to run
    void (*run)(void* self, Time now) = nullptr; ///< advances it to now; afterwards next() is later than now
};

/// Runs an engine's cycles in the world's place, to measure them. `run` calls engine.run(woken) once.
struct CycleRunner {
    void* self = nullptr;
    void (*run)(void* self, Engine& engine, bool woken) = nullptr;
};

class VirtualWorld {
public:
    /// The instance is configured and its clock is virtual.
    explicit VirtualWorld(MachineInstance& instance) noexcept;

    /// Adds a process, before start. Processes of one instant run in the order in which they were added,
    /// before the engines.
    void add(const VirtualProcess& process) noexcept { static_cast<void>(processes_.push(process)); }

    /// Sets the runner, before start. Without one, the world itself calls Engine::run.
    void run_cycles_by(const CycleRunner& runner) noexcept { runner_ = runner; }

    /// Makes cycles take time, up to their row's budget, drawn from the seed; call before start. On each
    /// processor the most urgent activity runs, and its effects become visible when its time is used up.
    /// Without this call cycles take no time.
    void take_times(std::uint64_t seed) noexcept { times_.emplace(seed); }
    /// The longest response so far, from the wake or the release to the end, when cycles take time.
    [[nodiscard]] Duration longest_response(std::size_t activity) const noexcept {
        return jobs_[activity].longest;
    }

    /// Sets how long initialise and finalise take when an activity changes. The other activities run
    /// meanwhile, and no stop waits for it. 0: no time.
    void makers_take(Duration time) noexcept { makers_take_ = time; }

    /// Starts the activities in the table's order. Returns the first refusal, with all stopped; empty: all
    /// started.
    Sentence start();
    /// Like RealWorld's; the other activities run while it takes time.
    [[nodiscard]] Sentence change_activity(std::size_t activity, LifeChange change);
    /// Makes the activity's thread hang: it runs no cycle before `until`, whatever wakes it. A stop completes
    /// nevertheless, as if the guardian wrote the safe values. For tests of the effects of a hang on the
    /// others.
    void hang(std::size_t activity, Time until) noexcept {
        hangs_until_[activity] = until;
        jobs_[activity].release = std::max(jobs_[activity].release, until); // a hang is no response
    }
    /// Runs to `end`; returns false when a stop is requested before.
    bool run_until(Time end);
    /// Stops the engines, the last row of the table first, then finalises their components.
    void stop();

    /// Returns a time, not before now, before which no engine runs, no other process wants to run, and
    /// run_until() does not return: for a process that may skip time.
    [[nodiscard]] Time quiet_until(const void* process) const;

    /// Returns when the next engine or process runs: for a caller that runs several worlds in turns.
    [[nodiscard]] Time next_time() const { return quiet(nullptr, never); }

    [[nodiscard]] std::uint64_t steps() const noexcept { return steps_; }

private:
    /// Limit of the engine runs in one instant, in which a message may wake another engine, and so on.
    static constexpr int max_rounds_per_instant = 1000;

    /// A cycle in progress.
    struct Job {
        bool is_there = false;
        bool woken = false;
        Time release{}, ended{};
        Duration left{};
        Duration longest{};
    };

    [[nodiscard]] ActivityControl control() noexcept;
    [[nodiscard]] bool is_ready(std::size_t activity, Time now);
    /// Returns the most urgent job of a processor; nowhere: none.
    [[nodiscard]] std::size_t at_work(int processor) const;
    void work_until(Time now);
    void run_engine(std::size_t activity, bool woken);
    void sleep_until(std::size_t activity, Time time);
    [[nodiscard]] Time quiet(const void* but, Time end) const;
    void run_engines(Time now);
    /// Runs the processes and engines of an instant.
    void run_instant(Time now);
    /// False: a stop was requested.
    [[nodiscard]] bool complete_change(std::size_t activity);
    /// Runs the others while the behaviours of one activity end.
    void end(std::size_t activity);

    MachineInstance& instance_;
    Bounded<VirtualProcess, 8> processes_{};
    CycleRunner runner_{};
    Bounded<std::size_t, max_activities> by_urgency_{};
    // For each engine, by row. It changes only while that engine runs, and reading it from the engine means
    // searching all its timers.
    std::array<Time, max_activities> wake_at_{};
    std::array<Time, max_activities> hangs_until_{};
    std::optional<Random> times_{}; ///< none: cycles take no time
    std::array<Job, max_activities> jobs_{};
    Time worked_until_{};
    std::array<std::optional<VirtualLoop>, max_activities> loops_{};
    Duration makers_take_{};
    Time makers_until_ = never; ///< completion of their functions
    Time end_{};                ///< of the run
    std::uint64_t steps_ = 0;
    bool is_ending_ = false; ///< engines run although a stop was requested
};

} // namespace tappet
