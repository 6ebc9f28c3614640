// The command line of the car tracker's program.
#pragma once

#include "kernel/base/text.hpp"

#include <cstdint>
#include <expected>
#include <string_view>

namespace tappet::car_tracking {

struct Options {
    std::uint64_t seed = 1;
    std::uint64_t seconds = 60;
    std::string_view picture{}; ///< file to write; empty: none
    bool help = false;
};

inline constexpr std::string_view usage =
    "car_tracking [--virtual] [--seed N] [--seconds N] [--picture FILE.svg]\n"
    "A steerable camera calibrates itself, then follows a toy car through a simulated room.\n"
    "  --virtual   the room's time; the only one there is, and may be left out\n"
    "  --seed      lens, track, noise: one seed is one run\n"
    "  --seconds   how long, 60 unless stated\n"
    "  --picture   where to write the picture of the run\n";

/// An error names the option and the cure.
[[nodiscard]] std::expected<Options, Sentence> parse_options(int count, const char* const* words);

} // namespace tappet::car_tracking
