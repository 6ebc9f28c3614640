// The lives of a component, which begin with its stops: by them a reader tells what a stop left from what
// stood there before.
#pragma once

#include "kernel/base/realtime.hpp"

#include <atomic>
#include <cstdint>

namespace tappet {

/// How often a component has left its safe values behind; and how many ports are forced, for who looks at
/// it from outside.
struct Stops {
    std::atomic<std::uint32_t> count{0};
    std::atomic<std::uint32_t>* forced = nullptr;
};

/// To the next one belongs what a stop leaves, and what is written after the next start.
using Life = std::uint64_t;
inline constexpr Life no_life = 0; ///< of a value that was never written, or that nobody wants any longer
inline constexpr Life first_life = 1;
constexpr Life life_after(std::uint64_t stops) noexcept TAPPET_REALTIME { return first_life + stops + 1; }

} // namespace tappet
