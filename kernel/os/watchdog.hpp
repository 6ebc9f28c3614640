// SPDX-License-Identifier: Apache-2.0
// The box's hardware watchdog: once opened it resets the box, unless it is kicked in time or disarmed.
#pragma once

#include "kernel/base/text.hpp"
#include "kernel/base/time.hpp"
#include "kernel/os/output_latch.hpp"

#include <expected>

namespace tappet::os {

/// Linux's watchdog device (Documentation/watchdog/watchdog-api.rst); no other code touches it. Not
/// real-time. It keeps running without stand_down(): after a guardian was killed, or a kernel hung.
class Watchdog {
public:
    /// Every kick checks `outputs`, which outlives this.
    explicit Watchdog(const OutputLatch& outputs) : outputs_{outputs} {}
    Watchdog(const Watchdog&) = delete;
    Watchdog& operator=(const Watchdog&) = delete;

    /// Starts the watchdog: from here on the box is reset when it was not kicked `within`, or sooner. The
    /// error names the cure; then nothing was started. Opening is a kick: it is refused while none is
    /// allowed.
    std::expected<void, Sentence> open(const char* path, Duration within) noexcept;
    /// Kicks four to eight times as often as required, while the latch allows it; otherwise does nothing.
    void kick(Time now) noexcept;
    /// Leaves the running watchdog to the next process that opens it, within the rest of the time. Without
    /// effect when it is not open.
    void hand_over() noexcept;
    /// Disarms the watchdog: no reset follows. While the outputs are not safe it only closes it, and the
    /// reset comes. Without effect when it is not open.
    void stand_down() noexcept;

private:
    void keep_alive() const noexcept;
    void close() noexcept;

    const OutputLatch& outputs_;
    int descriptor_ = -1;
    Duration every_{};
    Time next_{};
};

} // namespace tappet::os
