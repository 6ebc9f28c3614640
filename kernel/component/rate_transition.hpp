// What an input makes of a slower writer's values in its own cycles (Franklin, Powell and Workman, Digital
// Control of Dynamic Systems, 1998, chapter 6: holds of order nought and one).
#pragma once

#include "kernel/base/number.hpp"
#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"

#include <algorithm>
#include <cstdint>

namespace tappet {

enum class RateTransition : std::uint8_t {
    unsaid,      ///< as hold
    hold,        ///< the last value: steps, without delay
    interpolate, ///< a line to the last value, in one period of the writer: no steps, late by that period
    extrapolate  ///< the line on from the last two, for one period and by no more than their distance:
                 ///< neither, and beyond what was written
};

/// Of one floating input. Real-time, in its activity.
class BetweenValues {
public:
    BetweenValues(RateTransition how, Duration period) noexcept : how_{how}, period_{period} {}

    /// The value at `now`, after `written` came, which was true at `stamp`; or after none did. `begins`: it
    /// does not go on from the one before, which its writer wrote before it stopped.
    [[nodiscard]] double at(Time now, bool is_new, double written, Time stamp, bool begins = false) noexcept
        TAPPET_REALTIME {
        is_first_ |= begins;
        if (is_new) take(now, written, stamp);
        const Duration since = std::clamp(now - began_, Duration{}, period_);
        return from_ + slope_ * to_seconds(since);
    }

private:
    void take(Time now, double written, Time stamp) noexcept TAPPET_REALTIME {
        const double seconds = to_seconds(period_);
        // Nobody read it meanwhile: a line from there leads from the past.
        is_first_ |= now - began_ > 2 * period_;
        if (how_ == RateTransition::interpolate) {
            from_ = is_first_ ? written
                              : from_ + slope_ * to_seconds(std::clamp(now - began_, Duration{}, period_));
            slope_ = (written - from_) / seconds;
            began_ = now;
        } else {
            // Not by the distance of two stamps that lie closer than a period: what is measured twice at
            // almost one time would lead anywhere.
            slope_ = is_first_ || stamp <= began_
                         ? 0.0
                         : (written - from_) / to_seconds(std::max(stamp - began_, period_));
            from_ = written;
            began_ = stamp;
        }
        // From no number a line leads nowhere, and two may lie farther apart than any number says.
        if (!is_number(slope_)) from_ = written, slope_ = 0.0;
        is_first_ = false;
    }

    RateTransition how_;
    Duration period_;
    bool is_first_ = true;
    double from_ = 0.0;
    double slope_ = 0.0; ///< for each second
    Time began_{};
};

} // namespace tappet
