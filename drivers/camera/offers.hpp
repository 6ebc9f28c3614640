// Sets a video device to what a board says, or says what the device offers instead.
#pragma once

#include "drivers/camera/kind.hpp"

#include <cstdint>
#include <expected>

namespace tappet::camera {

/// ioctl() again after a signal; returns 0 or the errno. Not real-time.
[[nodiscard]] int request(int fd, unsigned long what, void* argument) noexcept;

/// Sets format, size, rate and exposure; returns the bytes from one row to the next. The error says what the
/// device offers. Not real-time.
std::expected<std::size_t, Sentence> set_picture(int fd, const CameraFacts& wanted);

} // namespace tappet::camera
