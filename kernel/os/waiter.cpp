// Waits on a futex, or, when there are devices, with poll on them and an eventfd.
#include "kernel/os/waiter.hpp"

#include "kernel/os/clock.hpp"

#include <linux/futex.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <ctime>

namespace tappet::os {

namespace {

timespec to_timespec(std::int64_t ns) noexcept TAPPET_REALTIME {
    return {static_cast<time_t>(ns / 1'000'000'000), static_cast<long>(ns % 1'000'000'000)};
}

constexpr short hang_up = POLLERR | POLLHUP | POLLNVAL; // poll reports them unasked, and at once

} // namespace

Waiter::~Waiter() {
    if (wake_descriptor_ >= 0) close(wake_descriptor_);
}

bool Waiter::watch(int descriptor) noexcept {
    if (wake_descriptor_ < 0) wake_descriptor_ = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
    if (wake_descriptor_ < 0 || devices_.full()) return false;
    drivers_[devices_.size()] = driver_;
    return devices_.push(descriptor);
}

void Waiter::serve(std::uint32_t driver, bool is_served) noexcept TAPPET_REALTIME {
    for (std::size_t i = 0; i < devices_.size(); ++i) {
        if (drivers_[i] != driver) continue;
        unserved_ = is_served ? unserved_ & ~(1u << i) : unserved_ | 1u << i;
    }
}

void Waiter::heed(int descriptor, bool wanted) noexcept TAPPET_REALTIME {
    for (std::size_t i = 0; i < devices_.size(); ++i) {
        if (devices_[i] != descriptor) continue;
        unheeded_ = wanted ? unheeded_ & ~(1u << i) : unheeded_ | 1u << i;
    }
}

void Waiter::wake() noexcept TAPPET_REALTIME {
    if (state_.exchange(woken, std::memory_order_seq_cst) != asleep) return; // waiter.wake
    if (wake_descriptor_ >= 0) {
        const std::uint64_t one = 1;
        TAPPET_ESCAPE("waking another activity",
                      [[maybe_unused]] auto n = write(wake_descriptor_, &one, sizeof one));
    } else {
        TAPPET_ESCAPE("waking another activity",
                      syscall(SYS_futex, &state_, FUTEX_WAKE_PRIVATE, 1, nullptr, nullptr, 0));
    }
}

bool Waiter::wait(Time until) noexcept TAPPET_REALTIME {
    if (take()) return true;
    if (!devices_.empty()) return wait_on_devices(devices_.size(), until);
    std::uint32_t expected = idle;
    if (state_.compare_exchange_strong(expected, asleep, std::memory_order_acq_rel)) { // waiter.doze
        const timespec end = to_timespec(to_ns(until));
        // Returns on a wake, at the end, on a signal, or at once when a wake came in between: the code below
        // handles all cases.
        TAPPET_ESCAPE("the activity's own wait",
                      syscall(SYS_futex, &state_, FUTEX_WAIT_BITSET_PRIVATE, asleep, // waiter.sleep
                              until == never ? nullptr : &end, nullptr, FUTEX_BITSET_MATCH_ANY));
    }
    return take();
}

bool Waiter::wait_without_devices(Time until) noexcept TAPPET_REALTIME {
    if (devices_.empty()) return wait(until);
    return take() || wait_on_devices(0, until);
}

// If the driver has taken the error since, it is gone, and the device is watched as before.
void Waiter::leave_out_hung(pollfd* polled, std::size_t count) noexcept TAPPET_REALTIME {
    const timespec at_once{};
    TAPPET_ESCAPE("a look that does not wait", ppoll(polled, count, &at_once, nullptr));
    for (std::size_t i = 0; i < count; ++i) {
        const bool still = (polled[i].revents & hang_up) != 0;
        if (!still) hung_ &= ~(1u << i);
        if (still && (hung_ >> i & 1u) != 0) polled[i].fd = -1;
        polled[i].revents = 0;
    }
}

bool Waiter::wait_on_devices(std::size_t count, Time until) noexcept TAPPET_REALTIME {
    pollfd polled[max_devices + 1] = {};
    for (std::size_t i = 0; i < count; ++i)
        polled[i] = {((unheeded_ | unserved_) >> i & 1u) != 0 ? -1 : devices_[i], POLLIN, 0}; // -1: ignored
    if (hung_ != 0) leave_out_hung(polled, count);
    polled[count] = {wake_descriptor_, POLLIN, 0};
    std::uint32_t expected = idle;
    if (state_.compare_exchange_strong(expected, asleep, std::memory_order_acq_rel)) { // waiter.doze
        const std::int64_t left = until == never ? 0 : (until - Clock::monotonic()).count();
        const timespec timeout = to_timespec(left > 0 ? left : 0);
        TAPPET_ESCAPE("the activity's own wait",
                      ppoll(polled, count + 1, until == never ? nullptr : &timeout, nullptr));
    }
    bool ready = take();
    for (std::size_t i = 0; i < count; ++i) {
        ready |= polled[i].revents != 0;
        if ((polled[i].revents & hang_up) != 0) hung_ |= 1u << i;
    }
    if (polled[count].revents != 0) {
        std::uint64_t wakes = 0;
        TAPPET_ESCAPE("taking the wake",
                      [[maybe_unused]] auto n = read(wake_descriptor_, &wakes, sizeof wakes));
    }
    return ready;
}

} // namespace tappet::os
