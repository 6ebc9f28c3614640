// SPDX-License-Identifier: Apache-2.0
// Text to consoles.
#include "board/box/voice.hpp"

#include <array>
#include <cstdio>
#include <ctime>

#include <fcntl.h>
#include <unistd.h>

namespace tappet::box {

double uptime_s() {
    timespec now{};
    ::clock_gettime(CLOCK_BOOTTIME, &now);
    return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

void Voice::open(const std::string& console) {
    const std::string path = "/dev/" + console.substr(0, console.find(','));
    if (const int descriptor = ::open(path.c_str(), O_WRONLY | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
        descriptor >= 0)
        consoles_.push_back(descriptor);
}

void Voice::say(std::string_view sentence) const {
    std::array<char, 32> time{};
    std::snprintf(time.data(), time.size(), "init: [%6.3f s] ", uptime_s());
    pass_on(std::string{time.data()} + std::string{sentence} + "\n");
}

void Voice::pass_on(std::string_view text) const {
    for (const int console : consoles_) {
        [[maybe_unused]] const auto written = ::write(console, text.data(), text.size());
    }
}

} // namespace tappet::box
