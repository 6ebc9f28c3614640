// The lives of a component, each of which begins with a stop. A reader uses them to tell what a stop left
// from earlier values.
#pragma once

#include "kernel/base/realtime.hpp"

#include <atomic>
#include <cstdint>

namespace tappet {

/// The number of a life: it begins with the values that a stop leaves, and includes those written after the
/// next start.
using Life = std::uint64_t;
inline constexpr Life never_lived = 0; ///< of a value that was never written
inline constexpr Life unwanted = 1;    ///< of a value that a force hid and that is abandoned
inline constexpr Life first_life = 2;

/// How often a component was stopped, also while it was stopped already, and how many lives ended with that:
/// in one number, so that nobody reads one without the other. `forced` counts the machine's forced ports, for
/// observers.
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
