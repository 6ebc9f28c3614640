// The clock of one machine: real (CLOCK_MONOTONIC) or virtual (stopped until the world moves it).
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"

namespace tappet::os {

class Clock {
public:
    enum class Kind : bool { real, virtual_time };
    explicit constexpr Clock(Kind kind) noexcept : virtual_{kind == Kind::virtual_time} {}

    /// Returns the machine's time. Real-time: the kernel's vDSO, no system call.
    [[nodiscard]] Time now() const noexcept TAPPET_REALTIME { return virtual_ ? virtual_now_ : monotonic(); }
    [[nodiscard]] bool is_virtual() const noexcept TAPPET_REALTIME { return virtual_; }

    /// Moves virtual time forward, never back.
    void advance_to(Time t) noexcept TAPPET_REALTIME {
        if (t > virtual_now_) virtual_now_ = t;
    }
    /// Consumes processor time: busy in real time, a step forward in virtual time. For fault injection and
    /// calibrated loads.
    void consume(Duration load) noexcept TAPPET_REALTIME;

    static Time monotonic() noexcept TAPPET_REALTIME;

private:
    bool virtual_;
    Time virtual_now_{};
};

/// Returns the processor time of the calling thread since it began. A system call that does not block:
/// real-time, but slower than a clock.
Duration processor_time_of_this_thread() noexcept TAPPET_REALTIME;

} // namespace tappet::os
