// The common values of the lane's machines: boards and their positions.
#pragma once

#include "kernel/base/time.hpp"

#include <cstdint>

namespace woodworking {

using namespace tappet;

/// A board's ticket, passed between stations: its number, and one bit for each station with work on it.
using Ticket = std::int32_t;
constexpr Ticket ticket(std::int32_t number, std::int32_t programme) noexcept {
    return number << 8 | programme;
}
constexpr std::int32_t number_of(Ticket board) noexcept { return board >> 8; }
constexpr bool has_work(Ticket board, int station) noexcept { return (board >> station & 1) != 0; }

inline constexpr int station_count = 4;
/// Position along the belt, mm, of a board's front while a station works on it; the light barrier is before
/// it.
constexpr std::int32_t stands_at(int station) noexcept { return 20'000 * (station + 1); }
inline constexpr std::int32_t barrier_before = 600;

inline constexpr double belt_speed = 1000.0;  // mm/s
inline constexpr double belt_brakes = 2000.0; // mm/s2

} // namespace woodworking
