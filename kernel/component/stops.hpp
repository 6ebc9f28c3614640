// The lives of a component, which begin with its stops: by them a reader tells what a stop left from what
// stood there before.
#pragma once

#include "kernel/base/realtime.hpp"

#include <atomic>
#include <cstdint>

namespace tappet {

/// To the next one belongs what a stop leaves, and what is written after the next start.
using Life = std::uint64_t;
inline constexpr Life never_lived = 0; ///< of a value that was never written
inline constexpr Life unwanted = 1;    ///< of one that a force hid, and that nobody wants any longer
inline constexpr Life first_life = 2;

/// How often a component was stopped, also while it stood, and how many lives ended so: in one number, so
/// that nobody reads one without the other. And how many ports are forced, for who looks at it from outside.
struct Stops {
    std::atomic<std::uint64_t> count{0};
    std::atomic<std::uint32_t>* forced = nullptr;

    static constexpr std::uint64_t of_one_that_stood = 1;
    static constexpr std::uint64_t of_a_life = (std::uint64_t{1} << 32u) + 1;
};
constexpr Life life_after(std::uint64_t stops) noexcept TAPPET_REALTIME {
    return first_life + (stops >> 32u) + 1;
}

} // namespace tappet
