// SPDX-License-Identifier: Apache-2.0
// What is known of a machine's outputs, and therefore whether the box's watchdog may be kicked.
#pragma once

#include "kernel/base/time.hpp"

#include <algorithm>
#include <cstdint>

namespace tappet::os {

/// Init has one, and each guardian: a Watchdog is kicked only while its latch allows it. Unsafe becomes safe
/// in one way: a guardian says so. One thread. tests/models/outputs.pml searches what init, firmware,
/// guardian and watchdog make of it.
class OutputLatch {
public:
    enum class State : std::uint8_t {
        safe,    ///< nothing has driven them since the box started, or a guardian has said so
        unknown, ///< a machine drives them
        unsafe,  ///< whatever drove them is gone, or does not live
    };

    [[nodiscard]] State state() const noexcept { return state_; }
    [[nodiscard]] bool is_safe() const noexcept { return state_ == State::safe; }

    /// A machine drives the outputs; it was seen to live, and will be looked at again before `until`. False,
    /// and without effect: they are unsafe, and no machine may be started.
    bool drive(Time until) noexcept {
        if (state_ == State::unsafe) return false;
        state_ = State::unknown; // latch.drive
        until_ = until;
        return true;
    }
    /// It ended before it could drive anything. Without effect when they are unsafe.
    void leave_untouched() noexcept {
        if (state_ == State::unknown) state_ = State::safe; // latch.untouched
    }
    /// Nobody vouches for them any more. The kicks of whoever makes them safe end at `until`: a second call
    /// can only bring that forward.
    void lose(Time until) noexcept {
        until_ = state_ == State::unsafe ? std::min(until_, until) : until; // latch.lose
        state_ = State::unsafe;
    }
    /// Only what a guardian did, or said, leads here.
    void guardian_says_safe() noexcept {
        state_ = State::safe; // latch.say
    }

    [[nodiscard]] bool may_kick(Time now) const noexcept { return is_safe() || now < until_; }

private:
    State state_ = State::safe;
    Time until_ = Time::min();
};

/// From the moment at which nobody drives the outputs a guardian kicks the watchdog for so long at most.
inline constexpr Duration guardian_acts_within = 10s;
/// What a guardian notifies its starter of.
inline constexpr const char* outputs_are_safe_notice = "X_TAPPET_OUTPUTS=safe";

} // namespace tappet::os
