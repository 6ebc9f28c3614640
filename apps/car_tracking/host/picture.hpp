// Draws the picture of a run: the field from above with the car's true and located track and the camera's
// aim, and below it the states over time.
#pragma once

#include "apps/car_tracking/host/record.hpp"

#include <span>
#include <string>

namespace tappet::car_tracking {

/// Returns an SVG document.
[[nodiscard]] std::string picture_of(std::span<const Moment> moments, std::span<const Look> looks);

} // namespace tappet::car_tracking
