// The computation of a cascade of three levels, law by law, and the same loop by hand: one function, no
// table. The components of cascade.cpp hold the same laws.
#pragma once

#include "kernel/motion/dynamics.hpp"
#include "kernel/motion/estimators.hpp"
#include "kernel/motion/least_squares.hpp"
#include "kernel/motion/path.hpp"
#include "kernel/motion/pid.hpp"
#include "kernel/motion/trajectory.hpp"
#include "tests/kernel/motion/robots.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

namespace tappet::figures::cascade {

using motion::Joints;

inline constexpr auto& arm = motion::folded<motion::robots::puma_560>;
using Arm = std::remove_cvref_t<decltype(arm)>;

inline constexpr Duration period = 1ms;
inline constexpr double period_s = to_seconds(period);

template <int n>
Joints<n> within(const Joints<n>& value, double most) noexcept TAPPET_REALTIME {
    Joints<n> result;
    for (int i = 0; i < n; ++i) result[i] = std::clamp(value[i], -most, most);
    return result;
}

template <int n, class Axis>
using Axes = std::array<Axis, static_cast<std::size_t>(n)>;
template <int n, class Axis>
Axes<n, Axis> all_axes(const Axis& one) {
    return [&]<std::size_t... i>(std::index_sequence<i...>) {
        return Axes<n, Axis>{((void)i, one)...};
    }(std::make_index_sequence<static_cast<std::size_t>(n)>{});
}

/// Counts of the encoders while somebody moves the arm a little: no value comes twice in 64 cycles.
template <int n>
class Counters {
public:
    Counters() {
        for (std::size_t k = 0; k < many; ++k)
            for (int i = 0; i < n; ++i)
                counts_[k][i] = std::round(1e4 * std::sin(0.098 * static_cast<double>(k) + 0.7 * i));
    }
    [[nodiscard]] const Joints<n>& next() noexcept TAPPET_REALTIME { return counts_[place_++ % many]; }

private:
    static constexpr std::size_t many = 64;
    std::array<Joints<n>, many> counts_;
    std::size_t place_ = 0;
};

/// Counts to radians.
template <int n>
struct Measure {
    Joints<n> operator()(const Joints<n>& counts) const noexcept TAPPET_REALTIME { return 1e-5 * counts; }
};
template <int n>
struct Observe {
    Axes<n, motion::AlphaBeta> axes = [] {
        constexpr motion::AlphaBeta one{motion::AlphaBetaGains::critically_damped(0.7)};
        return all_axes<n>(one);
    }();
    Joints<n> operator()(const Joints<n>& position, Time now) noexcept TAPPET_REALTIME {
        Joints<n> velocity;
        for (int i = 0; i < n; ++i) {
            motion::AlphaBeta& axis = axes[static_cast<std::size_t>(i)];
            axis.sample(position[i], now);
            velocity[i] = axis.velocity();
        }
        return velocity;
    }
};
/// The controlled quantity of the outermost level: the flange of a robot, or the position of one axis.
template <int n>
using Aim = std::conditional_t<n == 6, motion::FrameOf<Arm>, Joints<n>>;
template <int n>
using Speed = std::conditional_t<n == 6, motion::TwistOf<Arm>, Joints<n>>;

/// A jerk-limited motion to and fro.
template <int n>
struct Travel {
    motion::Profile share =
        *motion::jerk_limited(0.0, 1.0, {.velocity = 1.0, .acceleration = 4.0, .jerk = 40.0});
    using Line = motion::Path<Arm::Base, Arm::End>;
    Line line = *Line::line(forward(arm, Joints<6>{0.1, 0.6, 2.4, 0.2, 0.7, 0.3}),
                            forward(arm, Joints<6>{0.3, 0.7, 2.2, 0.1, 0.9, 0.2}));
    double at_s = 0.0;
    void operator()(Aim<n>& target, Speed<n>& speed) noexcept TAPPET_REALTIME {
        const double whole = share.duration_s();
        at_s += period_s;
        if (at_s >= 2.0 * whole) at_s -= 2.0 * whole;
        motion::AxisState now = share.at_s(at_s < whole ? at_s : 2.0 * whole - at_s);
        if (at_s >= whole) now.velocity = -now.velocity;
        if constexpr (n == 6) {
            const auto state = line.at(now);
            target = state.frame;
            speed = state.velocity;
        } else {
            target[0] = now.position;
            speed[0] = now.velocity;
        }
    }
};
/// A proportional controller with feed-forward of the speed.
template <int n>
struct Approach {
    Joints<n> operator()(const Aim<n>& target, const Speed<n>& speed,
                         const Joints<n>& position) const noexcept TAPPET_REALTIME {
        if constexpr (n == 6) {
            const auto pose = forward_with_jacobian(arm, position);
            auto wanted = difference(pose.frame, target);
            wanted.linear = speed.linear + 20.0 * wanted.linear;
            wanted.angular = speed.angular + 20.0 * wanted.angular;
            return damped_rates(pose.jacobian, wanted, 0.05, Joints<n>::Constant(2.0).eval())
                .value_or(Joints<n>::Zero());
        } else {
            return speed + 20.0 * (target - position);
        }
    }
};
/// Velocities change by no more than the acceleration allows.
template <int n>
struct Ease {
    Joints<n> now = Joints<n>::Zero();
    Joints<n> operator()(const Joints<n>& wanted) noexcept TAPPET_REALTIME {
        now += within<n>(wanted - now, 4.0 * period_s);
        return now;
    }
};
template <int n>
struct Follow {
    Axes<n, motion::Pid> axes = [] {
        constexpr motion::Pid one{
            {.proportional = 80.0, .integral = 400.0, .tracking_s = 0.1, .lowest = -30.0, .highest = 30.0}};
        return all_axes<n>(one);
    }();
    Joints<n> operator()(const Joints<n>& target, const Joints<n>& velocity) noexcept TAPPET_REALTIME {
        Joints<n> acceleration;
        for (int i = 0; i < n; ++i)
            acceleration[i] = axes[static_cast<std::size_t>(i)](target[i], velocity[i], period);
        return acceleration;
    }
};
template <int n>
struct Restrain {
    Joints<n> operator()(const Joints<n>& wanted) const noexcept TAPPET_REALTIME {
        return within<n>(wanted, 20.0);
    }
};
/// The dynamics of the PUMA 560 with its drives, or of one axis: a mass with friction.
template <int n>
struct Load {
    Joints<n> operator()(const Joints<n>& position, const Joints<n>& velocity,
                         const Joints<n>& acceleration) const noexcept TAPPET_REALTIME {
        if constexpr (n == 6)
            return inverse_dynamics(arm, position, velocity, acceleration);
        else
            return 0.35 * acceleration + 0.02 * velocity;
    }
};
template <int n>
struct Amplify {
    Joints<n> operator()(const Joints<n>& torque) const noexcept TAPPET_REALTIME {
        return within<n>(0.1 * torque, 10.0);
    }
};

template <int n>
struct ByHand {
    Counters<n> counters{};
    Joints<n> volts = Joints<n>::Zero();
    Measure<n> measure{};
    Observe<n> observe{};
    Travel<n> travel{};
    Approach<n> approach{};
    Ease<n> ease{};
    Follow<n> follow{};
    Restrain<n> restrain{};
    Load<n> load{};
    Amplify<n> amplify{};

    void cycle(Time now) noexcept TAPPET_REALTIME {
        const Joints<n> counts = counters.next();
        const Joints<n> position = measure(counts);
        const Joints<n> velocity = observe(position, now);
        Aim<n> target;
        Speed<n> speed;
        travel(target, speed);
        const Joints<n> wanted = approach(target, speed, position);
        const Joints<n> eased = ease(wanted);
        const Joints<n> acceleration = follow(eased, velocity);
        const Joints<n> restrained = restrain(acceleration);
        const Joints<n> torque = load(position, velocity, restrained);
        volts = amplify(torque);
    }
};

} // namespace tappet::figures::cascade
