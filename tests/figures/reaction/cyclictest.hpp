// The packaged cyclictest beside our own loop of its method: a cross-check from outside.
#pragma once

#include "tests/figures/measure/samples.hpp"

#include <cstddef>
#include <string>

namespace tappet::figures::reaction {

struct Outcome {
    Samples late_ns{};
    std::string why_not{}; ///< the reason why it could not run; empty: it ran
};

/// Runs that many wake-ups of one thread under SCHED_FIFO.
[[nodiscard]] Outcome run_cyclictest(int processor, int priority, std::size_t period_us, std::size_t count);

} // namespace tappet::figures::reaction
