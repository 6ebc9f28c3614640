// The true values of both robots in a run.
#pragma once

#include "apps/two_robots/tool/values.hpp"
#include "kernel/base/time.hpp"

#include <cstdint>
#include <string_view>
#include <vector>

namespace two_robots {

/// One moment: tip and shaft in the body's frame, and the body's origin in the base of the operating robot.
struct Moment {
    double at_s = 0.0;
    Eigen::Vector3d tip{}, body{};               ///< m
    bool is_inside = false;                      ///< the tip
    double beside_hole = 0.0;                    ///< of the shaft of a tip inside, m
    std::string_view tool_robot{}, body_robot{}; ///< their states
};

} // namespace two_robots
