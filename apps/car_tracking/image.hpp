// A camera's picture, and the image that the steerable camera makes of it for its users.
#pragma once

#include "apps/car_tracking/geometry.hpp"
#include "drivers/camera/image.hpp"

namespace tappet::car_tracking {

using camera::Colour;
using Picture = camera::Image<image_columns, image_rows>;

/// A picture with the aim that the camera believed to have at the exposure.
struct Image : Picture {
    Aim aim{};
};

} // namespace tappet::car_tracking
