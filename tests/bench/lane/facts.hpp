// The compiler's results for the lane, for a test that reads its wire.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

namespace tappet::bench {

[[nodiscard]] std::uint32_t beat_of(std::size_t node);
/// The longest of its stop times.
[[nodiscard]] std::chrono::nanoseconds proven_stop_time();

} // namespace tappet::bench
