// The picture of a run: the path of the tip as the body sees it, how far the shaft was from the middle of the
// hole, how the body moved, and the states of both robots.
#pragma once

#include "apps/two_robots/host/record.hpp"

#include <span>
#include <string>

namespace two_robots {

/// An SVG document.
[[nodiscard]] std::string picture_of(std::span<const Moment> moments);

} // namespace two_robots
