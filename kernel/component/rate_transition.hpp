// An input's values in its own cycles from those of a slower writer (Franklin, Powell and Workman, Digital
// Control of Dynamic Systems, 1998, chapter 6: holds of order zero and one).
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
    interpolate, ///< a line to the last value, in one period of the writer: no steps, one period late
    extrapolate ///< the line through the last two continued, for one period and by at most their distance: no
                ///< steps and no delay, but beyond what was written
};

/// The values of one floating input. Real-time, in its activity.
class BetweenValues {
public:
    BetweenValues(RateTransition how, Duration period) noexcept : how_{how}, period_{period} {}

    /// Returns the value at `now`. `is_new`: `written` came, which was true at `stamp`. `begins`: `written`
    /// does not continue the one before, which its writer wrote before it stopped.
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
        // Nobody read it meanwhile: a line from that value would start in the past.
        is_first_ |= now - began_ > 2 * period_;
        if (how_ == RateTransition::interpolate) {
            from_ = is_first_ ? written
                              : from_ + slope_ * to_seconds(std::clamp(now - began_, Duration{}, period_));
            slope_ = (written - from_) / seconds;
            began_ = now;
        } else {
            // Not over the distance of two stamps closer than a period: two measurements at almost one time
            // would give any slope.
            slope_ = is_first_ || stamp <= began_
                         ? 0.0
                         : (written - from_) / to_seconds(std::max(stamp - began_, period_));
            from_ = written;
            began_ = stamp;
        }
        // A line from NaN or infinity has no slope, and the distance of two numbers may exceed every number.
        if (!is_number(slope_)) from_ = written, slope_ = 0.0;
        is_first_ = false;
    }

    RateTransition how_;
    Duration period_;
    bool is_first_ = true;
    double from_ = 0.0;
    double slope_ = 0.0; ///< per second
    Time began_{};
};

} // namespace tappet
