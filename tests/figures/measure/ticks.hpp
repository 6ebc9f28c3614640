// The processor's time stamp counter: the cheapest clock there is, the same on every core of a machine with
// an invariant one.
#pragma once

#include <cstdint>
#include <x86intrin.h>

namespace tappet::figures {

/// A time stamp; what stands before it in the program has been done, what stands after it has not begun.
inline std::uint64_t ticks() noexcept {
    _mm_lfence();
    const std::uint64_t now = __rdtsc();
    _mm_lfence();
    return now;
}

/// What one tick takes, in ns: measured once against CLOCK_MONOTONIC, over 50 ms.
double ns_per_tick();
/// What reading the counter twice takes with nothing in between, in ticks: to be taken off each sample.
double ticks_of_reading();

} // namespace tappet::figures
