// Calibrates the time stamp counter.
#include "tests/figures/measure/ticks.hpp"

#include "tests/figures/measure/samples.hpp"

#include <chrono>

namespace tappet::figures {

double ns_per_tick() {
    static const double value = [] {
        using Clock = std::chrono::steady_clock;
        const auto begin = Clock::now();
        const std::uint64_t first = ticks();
        while (Clock::now() - begin < std::chrono::milliseconds{50}) {
        }
        const auto end = Clock::now();
        const std::uint64_t last = ticks();
        return std::chrono::duration<double, std::nano>(end - begin).count() /
               static_cast<double>(last - first);
    }();
    return value;
}

double ticks_of_reading() {
    static const double value = [] {
        Samples samples;
        for (int i = 0; i < 2000; ++i) {
            const std::uint64_t first = ticks();
            const std::uint64_t last = ticks();
            samples.add(static_cast<double>(last - first));
        }
        return samples.quantile(0.5);
    }();
    return value;
}

} // namespace tappet::figures
