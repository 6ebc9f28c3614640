// The processor's time stamp counter: the cheapest clock, the same on every core of a machine with an
// invariant counter.
#pragma once

#include <cstdint>
#include <x86intrin.h>

namespace tappet::figures {

/// A time stamp; everything before it in the program has completed, nothing after it has begun.
inline std::uint64_t ticks() noexcept {
    _mm_lfence();
    const std::uint64_t now = __rdtsc();
    _mm_lfence();
    return now;
}

/// The length of one tick in ns: measured once against CLOCK_MONOTONIC, over 50 ms.
double ns_per_tick();
/// The ticks between two immediate readings of the counter: subtract them from each sample.
double ticks_of_reading();

} // namespace tappet::figures
