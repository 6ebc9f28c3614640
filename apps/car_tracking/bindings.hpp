// Maps the tracker's sensor and its head to the devices of the box.
#pragma once

#include "drivers/camera/kind.hpp"
#include "kernel/machine/table/binding.hpp"

namespace tappet::car_tracking::bindings {

inline constexpr Binding camera_box =
    binding(wired("tracking-camera", "camera0", exposure(16ms)), wired("tracking-head", "can0"));

} // namespace tappet::car_tracking::bindings
