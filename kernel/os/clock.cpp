// Reads CLOCK_MONOTONIC. An injected load moves virtual time, and occupies the processor in real time.
#include "kernel/os/clock.hpp"

#include <ctime>

namespace tappet::os {

Time Clock::monotonic() noexcept TAPPET_REALTIME {
    timespec now{};
    TAPPET_ESCAPE("the vDSO reads the clock without a system call", clock_gettime(CLOCK_MONOTONIC, &now));
    return at_ns(static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec);
}

Duration processor_time_of_this_thread() noexcept TAPPET_REALTIME {
    timespec used{};
    TAPPET_ESCAPE("reads a counter of the kernel; never blocks",
                  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used));
    return Duration{static_cast<std::int64_t>(used.tv_sec) * 1'000'000'000 + used.tv_nsec};
}

void Clock::consume(Duration load) noexcept TAPPET_REALTIME {
    if (virtual_) {
        virtual_now_ += load;
        return;
    }
    const Time end = monotonic() + load;
    while (monotonic() < end) {
    }
}

} // namespace tappet::os
