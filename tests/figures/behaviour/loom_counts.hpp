// The events of the loom's cycle and the counts of its forms. C++17, because the peers need it.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tappet::figures {

enum LoomEvent : std::uint8_t { power, start, faster, slower, stop, pick, broken, reset };
inline constexpr std::size_t loom_events = 8;

/// The counts of a form; equal for equal events.
struct LoomCounts {
    std::int64_t exits = 0;
    std::int64_t entries = 0;
    std::int64_t picks = 0;
};

} // namespace tappet::figures
