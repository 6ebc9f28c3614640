// SPDX-License-Identifier: Apache-2.0
// The knowledge about a machine's outputs, and so the permission to kick the box's watchdog.
#pragma once

#include "kernel/base/time.hpp"

#include <algorithm>
#include <cstdint>

namespace tappet::os {

/// Init and each guardian have one: a Watchdog is kicked only while its latch allows it. Only a guardian's
/// word turns unsafe into safe. One thread. tests/models/outputs.pml searches its use by init, firmware,
/// guardian and watchdog.
class OutputLatch {
public:
    enum class State : std::uint8_t {
        safe,    ///< nothing has driven them since the box started, or a guardian said so
        unknown, ///< a machine drives them
        unsafe,  ///< the machine that drove them has ended, or does not live
    };

    [[nodiscard]] State state() const noexcept { return state_; }
    [[nodiscard]] bool is_safe() const noexcept { return state_ == State::safe; }

    /// Notes that a machine drives the outputs: it was seen to live, and will be checked again before
    /// `until`. Returns false, without effect, when they are unsafe: then no machine may be started.
    bool drive(Time until) noexcept {
        if (state_ == State::unsafe) return false;
        state_ = State::unknown; // latch.drive
        until_ = until;
        return true;
    }
    /// Notes that the machine ended before it could drive anything. Without effect when they are unsafe.
    void leave_untouched() noexcept {
        if (state_ == State::unknown) state_ = State::safe; // latch.untouched
    }
    /// Makes the outputs unsafe: nobody vouches for them any more. The process that makes them safe may kick
    /// until `until`; a second call can only bring that forward.
    void lose(Time until) noexcept {
        until_ = state_ == State::unsafe ? std::min(until_, until) : until; // latch.lose
        state_ = State::unsafe;
    }
    /// Makes the outputs safe. Call it only for what a guardian did or said.
    void guardian_says_safe() noexcept {
        state_ = State::safe; // latch.say
    }

    [[nodiscard]] bool may_kick(Time now) const noexcept { return is_safe() || now < until_; }

private:
    State state_ = State::safe;
    Time until_ = Time::min();
};

/// Longest time for which a guardian kicks the watchdog once nobody drives the outputs.
inline constexpr Duration guardian_acts_within = 10s;
/// The guardian's notification of its starter.
inline constexpr const char* outputs_are_safe_notice = "X_TAPPET_OUTPUTS=safe";

} // namespace tappet::os
