// Maps this robot's modules and lines on the bench, where one box runs both robots.
#pragma once

#include "apps/two_robots/bound_lines.hpp"

namespace two_robots::k361::bindings {

inline constexpr Binding bench = binding(wired("robot-can", "can0"), wired("camera-link", "0.0.0.0:5005"),
                                         wired("body-time", "127.0.0.1:5007"), lines_at("io"));

} // namespace two_robots::k361::bindings
