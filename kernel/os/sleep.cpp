// Sleeps until the time is over; continues after signals.
#include "kernel/os/sleep.hpp"

#include <cerrno>
#include <ctime>

namespace tappet::os {

void sleep_for(Duration time) noexcept {
    timespec left{static_cast<time_t>(time.count() / 1'000'000'000),
                  static_cast<long>(time.count() % 1'000'000'000)};
    while (clock_nanosleep(CLOCK_MONOTONIC, 0, &left, &left) == EINTR) {
    }
}

} // namespace tappet::os
