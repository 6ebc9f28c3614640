// Calibrates the counted loop.
#include "tests/figures/experiments/load.hpp"

#include "tests/figures/measure/samples.hpp"
#include "tests/figures/measure/ticks.hpp"

namespace tappet::experiments {

double calibrate_load() {
    constexpr std::uint64_t turns = 50'000; // some 100 us: shorter than most disturbances are apart
    constexpr int trials = 201;
    figures::Samples samples;
    for (int i = 0; i < trials; ++i) {
        const std::uint64_t first = figures::ticks();
        turn(turns);
        const std::uint64_t last = figures::ticks();
        samples.add(static_cast<double>(turns) /
                    (static_cast<double>(last - first) * figures::ns_per_tick()));
    }
    return samples.median();
}

} // namespace tappet::experiments
