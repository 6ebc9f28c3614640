// The signals of the camera's head: two axes with motor, encoder and index mark on a CAN bus.
#pragma once

#include "drivers/can/bus.hpp"

namespace tappet::car_tracking {

inline constexpr Duration head_period = 5ms;

// clang-format off
inline constexpr auto head_signals = can::signal_map(
    // Counts start at any value at power-on; passing the index mark stores its count.
    can::receive(can::standard(0x191), "pan", can::bytes(8), can::every(head_period),
        can::signal("counts", 0, 32).as_signed(),
        can::signal("index", 32, 24).as_signed(),
        can::signal("index_seen", 56, 1)),
    can::receive(can::standard(0x192), "tilt", can::bytes(8), can::every(head_period),
        can::signal("counts", 0, 32).as_signed(),
        can::signal("index", 32, 24).as_signed(),
        can::signal("index_seen", 56, 1)),
    can::transmit(can::standard(0x211), "drives", can::bytes(5), can::every(head_period),
        can::signal("on", 0, 1).safe(0), // off: the motors hold
        can::signal("pan_speed", 8, 16).as_signed().times(0.01).in("deg/s").safe(0),
        can::signal("tilt_speed", 24, 16).as_signed().times(0.01).in("deg/s").safe(0)));
// clang-format on

} // namespace tappet::car_tracking
