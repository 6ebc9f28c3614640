// The host of the figures, and the disturbances of a measurement there.
#pragma once

#include "tests/figures/report/run.hpp"

namespace tappet::figures {

/// Processor, caches, memory, kernel, clock, power management, isolation, compilers: name, value.
std::vector<std::pair<std::string, std::string>> describe_machine();

/// The commit of the tree in the working directory; "unknown" outside a repository.
std::string commit_of_tree();
/// Local time as ISO 8601.
std::string local_time();

/// Measures for that many seconds on that processor.
Noise measure_noise(int processor, double seconds);

/// Measures the use of the host from here on until usage().
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
