// SPDX-License-Identifier: Apache-2.0
// The box's hardware watchdog: once opened it resets the box, unless it is kicked in time or stood down.
#pragma once

#include "kernel/base/text.hpp"
#include "kernel/base/time.hpp"
#include "kernel/os/output_latch.hpp"

#include <expected>

namespace tappet::os {

/// Linux's watchdog device (Documentation/watchdog/watchdog-api.rst); no other code touches it. Not
/// real-time. What ends without stand_down() leaves it ticking: a guardian that is killed, or a kernel that
/// hangs.
class Watchdog {
public:
    /// Every kick asks `outputs`, which outlives this.
    explicit Watchdog(const OutputLatch& outputs) : outputs_{outputs} {}
    Watchdog(const Watchdog&) = delete;
    Watchdog& operator=(const Watchdog&) = delete;

    /// Begins: from here on the box is reset when it was not kicked `within`, or sooner. The error names the
    /// cure; then nothing has begun. Opening is a kick: it is refused while none is allowed.
    std::expected<void, Sentence> open(const char* path, Duration within) noexcept;
    /// At times four to eight times as often as it must, while the latch allows it; else it does nothing.
    void kick(Time now) noexcept;
    /// Leaves it to the next who opens it, within what is left of the time. Without effect when it is not
    /// open.
    void hand_over() noexcept;
    /// Ends: nothing is reset. While the outputs are not safe it only lets go, and the reset comes. Without
    /// effect when it is not open.
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
