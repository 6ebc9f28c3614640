// A controller that takes over while something moves: from the speed that is there to the one that it wants.
#pragma once

#include "kernel/base/number.hpp"
#include "kernel/base/realtime.hpp"

#include <algorithm>

namespace tappet {

/// Takes over without a bump: what there was is put out first, and its distance from what is wanted fades.
/// The output never leaves the range between the two: what was wanted at first, however far, is no reason to
/// move once it is not wanted any more. Real-time.
class HandOver {
public:
    /// Returns the first output. `is`: what was put out until now. `most`: what the actuator does at most,
    /// either way; beyond it there is no distance. What is no number is 0.
    constexpr double begin(double is, double wanted, double most) noexcept TAPPET_REALTIME {
        first_ = within(is, most);
        bump_ = first_ - within(wanted, most);
        share_ = 1.0;
        return first_;
    }
    /// `fades`: which share of the distance goes in this step, 0 to 1. What is no number is handed on.
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
