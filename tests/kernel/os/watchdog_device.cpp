// Handles the calls of Linux's watchdog interface, and no others.
#include "tests/kernel/os/watchdog_device.hpp"

#include <cerrno>
#include <cstdarg>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <linux/watchdog.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace {

struct {
    int seconds = 0, openings = 0, kicks = 0;
} device;

} // namespace

/// Replaces the library's function.
extern "C" int ioctl(int, unsigned long request, ...) noexcept {
    std::va_list more;
    va_start(more, request);
    void* const argument = va_arg(more, void*);
    va_end(more);
    switch (request) {
    case WDIOC_GETSUPPORT:
        ++device.openings;
        static_cast<watchdog_info*>(argument)->options = WDIOF_KEEPALIVEPING | WDIOF_MAGICCLOSE;
        return 0;
    case WDIOC_SETTIMEOUT: return 0;
    case WDIOC_GETTIMEOUT: *static_cast<int*>(argument) = device.seconds; return 0;
    case WDIOC_KEEPALIVE: ++device.kicks; return 0;
    default: errno = ENOTTY; return -1;
    }
}

namespace tappet::os {

WatchdogDevice::WatchdogDevice(int seconds) {
    path_ = (std::filesystem::temp_directory_path() / "tappet-watchdog-XXXXXX").string();
    if (const int file = ::mkstemp(path_.data()); file >= 0) ::close(file);
    device = {};
    device.seconds = seconds;
}
WatchdogDevice::~WatchdogDevice() { std::filesystem::remove(path_); }
int WatchdogDevice::openings() const { return device.openings; }
int WatchdogDevice::kicks() const { return device.kicks; }
bool WatchdogDevice::is_stood_down() const {
    std::ifstream file{path_};
    const std::string written{std::istreambuf_iterator<char>{file}, {}};
    return written.ends_with('V');
}

} // namespace tappet::os
