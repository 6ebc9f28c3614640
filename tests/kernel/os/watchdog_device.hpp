// A watchdog device for tests: a file, and a replaced ioctl that counts the requests of a Watchdog.
#pragma once

#include <string>

namespace tappet::os {

/// Only one at a time; it starts with the test that creates it.
class WatchdogDevice {
public:
    explicit WatchdogDevice(int seconds = 8);
    ~WatchdogDevice();
    WatchdogDevice(const WatchdogDevice&) = delete;
    WatchdogDevice& operator=(const WatchdogDevice&) = delete;

    [[nodiscard]] const char* path() const { return path_.c_str(); }
    [[nodiscard]] int openings() const;
    [[nodiscard]] int kicks() const;
    /// It was told to disarm: no reset follows.
    [[nodiscard]] bool is_stood_down() const;

private:
    std::string path_;
};

} // namespace tappet::os
