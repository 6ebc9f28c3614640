// The angles of the carpet loom: one turn of the main shaft is one pick.
#pragma once

#include "apps/carpet_loom/wires.hpp"
#include "kernel/cam/table.hpp"

namespace tappet::carpet {

namespace wires = loom::wires;

namespace detail {

constexpr Rotation deg(double degrees) { return Rotation::degrees(degrees); }

} // namespace detail

// clang-format off
inline constexpr auto cams = cam_table(700_rpm,
    cam("beat_up",        at(0_deg)),
    cam("offer_pattern",  at(20_deg)),
    cam("weft_release",   window(detail::deg(wires::nominal::weft_release_deg), 200_deg),
                          dead_time(wires::nominal::weft_release_dead, 0us), min_speed(30_rpm)),
    cam("arrival_window", window(detail::deg(wires::nominal::weft_window_begin_deg), detail::deg(wires::nominal::weft_window_end_deg))));
// clang-format on

static_assert(check(cams.view()).empty(), "the cam table is refused: check(cams.view()) is the sentence");

} // namespace tappet::carpet
