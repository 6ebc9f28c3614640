// Draws the picture of a run: the tip's path in the body's frame, the distance of the shaft from the middle
// of the hole, the body's motion, and the states of both robots.
#pragma once

#include "apps/two_robots/host/record.hpp"

#include <span>
#include <string>

namespace two_robots {

/// Returns an SVG document.
[[nodiscard]] std::string picture_of(std::span<const Moment> moments);

} // namespace two_robots
