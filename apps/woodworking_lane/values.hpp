// What the machines of the lane speak of: boards, and where they are.
#pragma once

#include "kernel/base/time.hpp"

#include <cstdint>

namespace woodworking {

using namespace tappet;

/// A board as it is handed on: its number, and one bit for each station that has work on it.
using Ticket = std::int32_t;
constexpr Ticket ticket(std::int32_t number, std::int32_t programme) noexcept {
    return number << 8 | programme;
}
constexpr std::int32_t number_of(Ticket board) noexcept { return board >> 8; }
constexpr bool has_work(Ticket board, int station) noexcept { return (board >> station & 1) != 0; }

inline constexpr int station_count = 4;
/// Along the belt, mm: where a board's front stands while a station works on it, and the light barrier before
/// it.
constexpr std::int32_t stands_at(int station) noexcept { return 20'000 * (station + 1); }
inline constexpr std::int32_t barrier_before = 600;

inline constexpr double belt_speed = 1000.0;  // mm/s
inline constexpr double belt_brakes = 2000.0; // mm/s2

} // namespace woodworking
