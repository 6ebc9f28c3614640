// One experiment: an application in one setting, run for a while, and the records of its tasks.
#pragma once

#include "tests/figures/experiments/applications.hpp"
#include "tests/figures/measure/samples.hpp"

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace tappet::experiments {

/// The results of one task in one setting, over all rounds. Periods and latencies in us, the rest in ns.
struct TaskResult {
    std::string name;
    double period_us = 0; ///< from the table
    double load_us = 0;
    bool real_time = false;
    figures::Samples periods{};      ///< from begin to begin
    figures::Samples latencies{};    ///< from begin to end
    figures::Samples exchanges{};    ///< in each execution, around data flow
    figures::Samples copies{};       ///< the same packets, copied by one thread
    figures::Samples one_message{};  ///< stored in place, and announced by an atomic OR
    figures::Samples two_messages{}; ///< in two places
    figures::Samples sends{};        ///< of one command, or of one event
    figures::Samples one_served{};
    figures::Samples two_served{}; ///< after one execution
    figures::Samples served{};     ///< any number above zero
    std::uint64_t executions = 0;
    std::uint64_t waited_for_locks = 0;
    std::int64_t blocked = 0; ///< times it gave up the processor although it had work to do
    std::uint64_t misses = 0; ///< deadlines
};

struct Experiment {
    std::string application;
    Setting setting = Setting::none;
    std::vector<TaskResult> tasks{}; ///< the most urgent first
};

struct Circumstances {
    double turns_per_ns = 0;
    double ns_per_tick = 0;
    std::uint64_t ticks_of_stamps = 0;
};

/// Runs it for `seconds` and adds to `into`. Empty: done; else the reason why not.
std::string run_experiment(const Application& application, const Circumstances& circumstances, double seconds,
                           Experiment& into);

/// Runs the highest priority of an application alone: one bare thread with its period and its load, by
/// cyclictest's method. It shows the behaviour of the machine, not of a framework. Returns as
/// run_experiment().
std::string run_bare(const Application& application, const Circumstances& circumstances, double seconds,
                     TaskResult& into);

/// The time that is left out at the beginning of a run of that length: caches, page faults, the start of the
/// others.
constexpr Duration warming_of(Duration whole) { return std::min<Duration>(50ms, whole / 2); }

/// Turns the records of a task into samples, without the first `warming` ticks.
void evaluate(std::span<const Execution> executions, Setting setting, double ns_per_tick,
              std::uint64_t warming, TaskResult& into);

} // namespace tappet::experiments
