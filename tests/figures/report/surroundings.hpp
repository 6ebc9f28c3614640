// The machine that the figures were taken on, and what disturbs a measurement there.
#pragma once

#include "tests/figures/report/run.hpp"

namespace tappet::figures {

/// Processor, caches, memory, kernel, clock, power management, isolation, compilers: what, value.
std::vector<std::pair<std::string, std::string>> describe_machine();

/// Of the tree that it is started in; "unknown" outside a repository.
std::string commit_of_tree();
/// Local time as ISO 8601.
std::string local_time();

/// Takes so many seconds on that processor.
Noise measure_noise(int processor, double seconds);

/// What happens from here on until usage().
class Meter {
public:
    Meter();
    [[nodiscard]] Usage usage() const;

private:
    struct Counters {
        double seconds = 0, busy = 0, steal = 0, all = 0, switches = 0, interrupts = 0;
    };
    static Counters read();
    Counters begin_;
};

} // namespace tappet::figures
