// Turns the pixels of a frame into the colours of an image.
#pragma once

#include "drivers/camera/device.hpp"
#include "drivers/camera/image.hpp"

namespace tappet::camera {

/// Writes the frame's pixels as colours, row by row. `into` has size.columns * size.rows; the frame is one
/// that Device::take() found good for that size. Real-time.
void decode(const Frame& frame, Size size, std::span<Colour> into) noexcept TAPPET_REALTIME;

} // namespace tappet::camera
