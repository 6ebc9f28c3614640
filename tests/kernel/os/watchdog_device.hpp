// A watchdog device for tests: a file, and this program's own ioctl, which counts what a Watchdog asks of it.
#pragma once

#include <string>

namespace tappet::os {

/// One at a time; it begins with the test that makes it.
class WatchdogDevice {
public:
    explicit WatchdogDevice(int seconds = 8);
    ~WatchdogDevice();
    WatchdogDevice(const WatchdogDevice&) = delete;
    WatchdogDevice& operator=(const WatchdogDevice&) = delete;

    [[nodiscard]] const char* path() const { return path_.c_str(); }
    [[nodiscard]] int openings() const;
    [[nodiscard]] int kicks() const;
    /// It was told that nothing is to be reset.
    [[nodiscard]] bool is_stood_down() const;

private:
    std::string path_;
};

} // namespace tappet::os
