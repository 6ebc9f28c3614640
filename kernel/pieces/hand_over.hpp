// Bumpless hand-over: a controller takes over a moving axis, from its present to the wanted speed.
#pragma once

#include "kernel/base/number.hpp"
#include "kernel/base/realtime.hpp"

#include <algorithm>

namespace tappet {

/// Takes over without a bump: outputs the present value first, then fades out its distance from the wanted
/// value. The output stays between the two: a distant first request causes no motion once it is withdrawn.
/// Real-time.
class HandOver {
public:
    /// Returns the first output. `is`: the output until now. `most`: the actuator's limit, in both
    /// directions; beyond it no distance is kept. NaN and infinity count as 0.
    constexpr double begin(double is, double wanted, double most) noexcept TAPPET_REALTIME {
        first_ = within(is, most);
        bump_ = first_ - within(wanted, most);
        share_ = 1.0;
        return first_;
    }
    /// `fades`: the share of the distance removed in this step, 0..1. NaN and infinity are passed on.
    constexpr double operator()(double wanted, double fades) noexcept TAPPET_REALTIME {
        share_ *= 1.0 - std::clamp(fades, 0.0, 1.0);
        const double first = share_ * first_;
        return std::clamp(wanted + share_ * bump_, std::min(wanted, first), std::max(wanted, first));
    }

private:
    static constexpr double within(double value, double most) noexcept TAPPET_REALTIME {
        return is_number(value) ? std::clamp(value, -most, most) : 0.0;
    }
    double first_ = 0.0, bump_ = 0.0, share_ = 0.0;
};

} // namespace tappet
