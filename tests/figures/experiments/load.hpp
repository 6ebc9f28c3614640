// A load: a counted loop that takes a stated time on this machine (thesis A.2.2: each task is calibrated).
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"

#include <cstdint>

namespace tappet::experiments {

/// Executes that many turns of a loop in which each waits for the one before, so that no processor can
/// overlap them.
inline void turn(std::uint64_t turns) noexcept TAPPET_REALTIME {
    std::uint64_t value = turns;
    for (std::uint64_t i = 0; i < turns; ++i) {
        value = value * 6364136223846793005u + 1442695040888963407u;
        asm volatile("" : "+r"(value));
    }
}

/// The number of turns that take that time.
inline std::uint64_t turns_for(Duration time, double turns_per_ns) {
    return static_cast<std::uint64_t>(static_cast<double>(time.count()) * turns_per_ns);
}

} // namespace tappet::experiments
