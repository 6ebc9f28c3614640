// The highest priority of an application without the application: one bare thread with its period and its
// load, by cyclictest's method. What it shows is the machine's doing, not a framework's.
#pragma once

#include "tests/figures/experiments/run.hpp"

namespace tappet::experiments {

/// Runs it for `seconds` and adds to `into`. Empty: done; else why not.
std::string run_bare(Duration period, Duration load, const Circumstances& circumstances, double seconds,
                     TaskResult& into);

/// Period and load of an application's task "high", as its table says.
struct Highest {
    Duration period, load;
};
Highest highest_of(const Application& application);

} // namespace tappet::experiments
