// How the box itself is: warm, full, guarded.
#pragma once

#include <optional>
#include <string_view>

namespace tappet::os {

/// Of the kernel's thermal zones the hottest, in degrees Celsius; none when the box has no sensor. `root`
/// stands before /sys. Not real-time, as the others.
[[nodiscard]] std::optional<double> hottest_celsius(std::string_view root = "") noexcept;

/// Free for a user on the disk that a folder lies on, in MB; none when it cannot be told.
[[nodiscard]] std::optional<double> free_megabytes(const char* folder) noexcept;

/// Whether a hardware watchdog counts now.
[[nodiscard]] bool watchdog_counts(std::string_view root = "") noexcept;

} // namespace tappet::os
