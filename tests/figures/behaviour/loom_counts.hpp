// The events of the loom's cycle and what its forms count. C++17, for the peers' sake.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tappet::figures {

enum LoomEvent : std::uint8_t { power, start, faster, slower, stop, pick, broken, reset };
inline constexpr std::size_t loom_events = 8;

/// What a form has counted; equal for equal events.
struct LoomCounts {
    std::int64_t exits = 0;
    std::int64_t entries = 0;
    std::int64_t picks = 0;
};

} // namespace tappet::figures
