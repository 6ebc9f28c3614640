// The kernel's values in /sys.
#include "kernel/os/health.hpp"

#include "kernel/os/system_file.hpp"

#include <algorithm>
#include <charconv>

#include <sys/statvfs.h>

namespace tappet::os {

namespace {
constexpr int most_zones = 32;
}

std::optional<double> hottest_celsius(std::string_view root) noexcept {
    std::optional<double> hottest;
    for (int zone = 0; zone < most_zones; ++zone) {
        const SystemFile file{root, Sentence{"/sys/class/thermal/thermal_zone", zone, "/temp"}};
        if (!file.readable) continue;
        int millidegrees = 0;
        const std::string_view text = file.text();
        if (std::from_chars(text.data(), text.data() + text.size(), millidegrees).ec != std::errc{}) continue;
        hottest = std::max(hottest.value_or(-273.15), millidegrees / 1000.0);
    }
    return hottest;
}

std::optional<double> free_megabytes(const char* folder) noexcept {
    struct statvfs facts{};
    if (::statvfs(folder, &facts) != 0) return std::nullopt;
    return static_cast<double>(facts.f_bavail) * static_cast<double>(facts.f_frsize) * 1e-6;
}

bool watchdog_counts(std::string_view root) noexcept {
    return SystemFile{root, Sentence{"/sys/class/watchdog/watchdog0/state"}}.text() == "active";
}

} // namespace tappet::os
