// Extrapolates a shaft's motion from one instant: its position at a time, and the time of a position.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"
#include "kernel/cam/angle.hpp"

#include <algorithm>
#include <cmath>

namespace tappet {

/// Position, velocity and acceleration of a shaft at one time.
struct ShaftState {
    ShaftPosition position;
    double velocity_deg_s = 0.0;
    double acceleration_deg_s2 = 0.0;
};

/// A shaft's motion from `stamp` on: the acceleration holds for `horizon_s`, then the velocity stays
/// constant; a braking shaft stops and does not turn back. Before `stamp` the velocity is taken as constant.
struct ShaftMotion {
    ShaftState state;
    Time stamp{};
    double horizon_s = 0.02;

    /// Returns the state at `t`. Real-time.
    [[nodiscard]] ShaftState at(Time t) const noexcept TAPPET_REALTIME {
        const double v = state.velocity_deg_s;
        const double a = state.acceleration_deg_s2;
        const double dt = to_seconds(t - stamp);
        if (dt <= 0.0) return {state.position + Rotation::degrees(v * dt), v, a};
        const double bent = std::min(std::min(dt, horizon_s), stop_after_s(v, a));
        const double reached_v = bent < dt && bent < horizon_s ? 0.0 : v + a * bent;
        const double moved = (v + 0.5 * a * bent) * bent + reached_v * (dt - bent);
        return {state.position + Rotation::degrees(moved), reached_v, bent < dt ? 0.0 : a};
    }

    /// Returns the same motion, starting at `t` or at its stamp, whichever is later. Real-time.
    [[nodiscard]] ShaftMotion from(Time t) const noexcept TAPPET_REALTIME {
        if (t <= stamp) return *this;
        return {at(t), t, std::max(0.0, horizon_s - to_seconds(t - stamp))};
    }

    /// Returns the first time from `stamp` on at which the shaft is at `target`, moving on in its present
    /// direction; `never` when it stands, stops before, or has already passed. Real-time: one square root, no
    /// loop.
    [[nodiscard]] Time when(ShaftPosition target) const noexcept TAPPET_REALTIME {
        const bool backward = state.velocity_deg_s < 0.0;
        const double way_forward = (target - state.position).in_degrees();
        const double way = backward ? -way_forward : way_forward;
        const double v = backward ? -state.velocity_deg_s : state.velocity_deg_s;
        const double a = backward ? -state.acceleration_deg_s2 : state.acceleration_deg_s2;
        if (v == 0.0 || way < 0.0) return never;
        const double bent_way = (v + 0.5 * a * horizon_s) * horizon_s;
        double after_s = 0.0;
        if (v + a * horizon_s <= 0.0 || way <= bent_way) {
            const double square = v * v + 2.0 * a * way;
            if (square < 0.0) return never;
            after_s = 2.0 * way / (v + std::sqrt(square)); // stable: no difference of near numbers
        } else {
            after_s = horizon_s + (way - bent_way) / (v + a * horizon_s);
        }
        if (!(after_s < longest_s)) return never;
        return stamp + Duration{static_cast<std::int64_t>(after_s * 1e9 + 0.5)};
    }
    /// Returns the same, from `not_before` on when that is later than `stamp`.
    [[nodiscard]] Time when(ShaftPosition target, Time not_before) const noexcept TAPPET_REALTIME {
        return from(not_before).when(target);
    }

private:
    static constexpr double longest_s = 3600.0; // beyond an hour a prediction is meaningless

    static double stop_after_s(double v, double a) noexcept TAPPET_REALTIME {
        return v * a < 0.0 ? -v / a : longest_s;
    }
};

} // namespace tappet
