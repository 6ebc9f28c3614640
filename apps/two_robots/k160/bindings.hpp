// Maps this robot's modules and lines on the bench, where one box runs both robots.
#pragma once

#include "apps/two_robots/bound_lines.hpp"

namespace two_robots::k160::bindings {

inline constexpr Binding bench =
    binding(wired("robot-can", "can1"), wired("time-port", "0.0.0.0:5007"), lines_at("panel"));

} // namespace two_robots::k160::bindings
