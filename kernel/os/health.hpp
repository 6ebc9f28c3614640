// The condition of the box: temperature, disk space, watchdog.
#pragma once

#include <optional>
#include <string_view>

namespace tappet::os {

/// Returns the temperature of the hottest thermal zone of the kernel, in degrees Celsius; none when the box
/// has no sensor. `root` is a prefix of /sys. Not real-time, like the others.
[[nodiscard]] std::optional<double> hottest_celsius(std::string_view root = "") noexcept;

/// Returns the space for a user on the disk of a folder, in MB; none when it is unknown.
[[nodiscard]] std::optional<double> free_megabytes(const char* folder) noexcept;

/// Returns whether a hardware watchdog is running.
[[nodiscard]] bool watchdog_counts(std::string_view root = "") noexcept;

} // namespace tappet::os
