// Controllers of both robots: control joints by their error, with or without feed-forward of the rate.
#pragma once

#include "apps/two_robots/values.hpp"
#include "kernel/component/component.hpp"
#include "kernel/pieces/hand_over.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace two_robots {

/// The common part of both. They take over from the last sent rates, and the difference fades. They brake
/// before a joint's limit, as soon as its angle is known. Real-time.
struct JointController {
    Input<Joints> target, rate, positions, sent;
    Input<bool> calibrated;
    Output<Joints> wanted;
    Property<double> kp{10.0}, braking{1.0};
    Property<Joints> lowest{Joints::Constant(-3.0)}, highest{Joints::Constant(3.0)};

protected:
    void begin(const Joints& would) noexcept TAPPET_REALTIME {
        const Joints is = sent.get();
        Joints rates;
        for (int i = 0; i < 6; ++i)
            rates[i] = take_over_[static_cast<std::size_t>(i)].begin(is[i], would[i], fastest);
        wanted.write(rates);
    }
    void put(const Joints& next, const Cycle& cycle) noexcept TAPPET_REALTIME {
        Joints rates;
        for (int i = 0; i < 6; ++i)
            rates[i] = take_over_[static_cast<std::size_t>(i)](next[i], fading * to_seconds(cycle.period));
        if (calibrated.get()) {
            const Joints now = positions.get();
            for (int i = 0; i < 6; ++i)
                rates[i] = std::clamp(rates[i], -reaches(now[i] - lowest.get()[i]),
                                      reaches(highest.get()[i] - now[i]));
        }
        wanted.write(rates);
    }
    template <class Own, class... Facets>
    static constexpr auto controller_facets(const Facets&... more) {
        return facets(input<&Own::target>("target", "rad", "where the joints shall be"),
                      input<&Own::rate>("rate", "rad/s", "of the joints at the target"),
                      input<&Own::positions>("positions", "rad", "of the joints"),
                      input<&Own::sent>("sent", "rad/s", "to the drives in the step before"),
                      input<&Own::calibrated>("calibrated", "", "the positions are angles of the arm"),
                      output<&Own::wanted>("wanted", "rad/s", "of the drives"),
                      property<&Own::kp>("kp", "1/s", "rate for an error", range(0.1, 12.0)),
                      property<&Own::braking>("braking", "rad/s^2", "before a joint ends", range(0.1, 4.0)),
                      property<&Own::lowest>("lowest", "rad", "where the joints end", range(-6.3, 6.3)),
                      property<&Own::highest>("highest", "rad", "where the joints end", range(-6.3, 6.3)),
                      more...);
    }

private:
    /// Returns the highest rate from which the joint still stops within `way`.
    [[nodiscard]] double reaches(double way) const noexcept TAPPET_REALTIME {
        return way > 0.0 ? std::sqrt(2.0 * way * braking.get()) : 0.0;
    }

    static constexpr double fading = 10.0; // 1/s
    static constexpr double fastest = 0.5; // rad/s, which no drive exceeds: see JointEffector
    std::array<HandOver, 6> take_over_{};
};

/// Controls by the error and its integral alone.
struct JointPid : JointController {
    Property<double> ki{0.0};

    void start(const Cycle&) noexcept TAPPET_REALTIME {
        sum_ = Joints::Zero();
        begin(kp.get() * (target.get() - positions.get()));
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        const Joints error = target.get() - positions.get();
        const Joints before = wanted.last();
        for (int i = 0; i < 6; ++i) // what the Effector cut off is not integrated
            if (sent.get()[i] == before[i]) sum_[i] += ki.get() * error[i] * to_seconds(cycle.period);
        sum_ = within(sum_, most_sum);
        put(kp.get() * error + sum_, cycle);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { wanted.write(Joints::Zero()); }
    static constexpr auto interface() {
        return controller_facets<JointPid>(
            property<&JointPid::ki>("ki", "1/s^2", "of the error's sum", range(0.0, 2.0)));
    }

private:
    static constexpr double most_sum = 0.05; // rad/s
    Joints sum_ = Joints::Zero();
};

/// Controls by the rate of the set points plus a term proportional to the error.
struct JointFeedForward : JointController {
    void start(const Cycle&) noexcept TAPPET_REALTIME { begin(would()); }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME { put(would(), cycle); }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { wanted.write(Joints::Zero()); }
    static constexpr auto interface() { return controller_facets<JointFeedForward>(); }

private:
    [[nodiscard]] Joints would() noexcept TAPPET_REALTIME {
        return rate.get() + kp.get() * (target.get() - positions.get());
    }
};

} // namespace two_robots
