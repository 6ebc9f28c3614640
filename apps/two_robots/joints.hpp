// The ends of a robot's control loop: joint angles from encoders, and velocities to drives.
#pragma once

#include "apps/two_robots/values.hpp"
#include "kernel/base/unwrapped_count.hpp"
#include "kernel/component/component.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace two_robots {

/// Counts per rad of encoders with 4096 counts a turn behind gears; negative gears invert the direction.
constexpr std::array<double, 6> counts_of(const std::array<double, 6>& gears) noexcept {
    std::array<double, 6> counts{};
    for (std::size_t i = 0; i < 6; ++i) counts[i] = gears[i] * 4096 / (2 * std::numbers::pi);
    return counts;
}

/// Sensor: positions and rates of six joints. Relative encoders count from power-on, until somebody sets the
/// angle of a joint. Real-time.
struct JointSensor {
    Input<std::int64_t> counts_1, counts_2, counts_3, counts_4, counts_5, counts_6;
    Output<Joints> positions, rates;
    Output<bool> calibrated;
    Property<Joints> counts_per_rad{Joints::Ones()};
    Property<bool> absolute{false};

    void start(const Cycle& cycle) noexcept TAPPET_REALTIME {
        known_ = absolute.get() ? all : 0;
        for (UnwrappedCount& each : counts_) each.lose();
        has_seen_ = false;
        step(cycle);
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        const std::array<Input<std::int64_t>*, 6> inputs{&counts_1, &counts_2, &counts_3,
                                                         &counts_4, &counts_5, &counts_6};
        Joints now;
        for (std::size_t i = 0; i < 6; ++i) {
            if (!inputs[i]->good()) return; // writes nothing: the readers become stale
            const auto way = static_cast<double>(counts_[i].take(inputs[i]->get(), 32));
            const double angle = way / counts_per_rad.get()[static_cast<int>(i)] + zero_[static_cast<int>(i)];
            if (!is_angle(angle)) return; // as above
            now[static_cast<int>(i)] = angle;
        }
        // Divides by the time since the last angles: cycles in between may have had none.
        const Duration passed = has_seen_ ? cycle.release - seen_at_ : Duration::zero();
        positions.write(now);
        rates.write(passed > Duration::zero() ? Joints{(now - seen_) / to_seconds(passed)} : Joints::Zero());
        seen_ = now;
        seen_at_ = cycle.release;
        has_seen_ = true;
        calibrated.write(known_ == all);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { rates.write(Joints::Zero()); }

    /// Sets the present angle of joint `axis` (1 to 6).
    void calibrate(int axis, double angle) noexcept TAPPET_REALTIME {
        const int i = axis - 1;
        if (i < 0 || i >= 6 || !is_angle(angle)) return; // no joint, or an impossible angle
        const double moved = angle - seen_[i];
        zero_[i] += moved;
        seen_[i] += moved; // this step is no motion
        known_ |= 1U << i;
    }
    bool is_calibrated(int axis) noexcept TAPPET_REALTIME {
        return axis >= 1 && axis <= 6 && (known_ >> (axis - 1) & 1U) != 0;
    }

    // clang-format off
    static constexpr auto interface() {
        return facets(
            input<&JointSensor::counts_1>("counts_1", "", "of the encoder's register"), input<&JointSensor::counts_2>("counts_2", "", "of the encoder's register"),
            input<&JointSensor::counts_3>("counts_3", "", "of the encoder's register"), input<&JointSensor::counts_4>("counts_4", "", "of the encoder's register"),
            input<&JointSensor::counts_5>("counts_5", "", "of the encoder's register"), input<&JointSensor::counts_6>("counts_6", "", "of the encoder's register"),
            output<&JointSensor::positions>("positions", "rad", "of the joints"),
            output<&JointSensor::rates>("rates", "rad/s", "of the joints"),
            output<&JointSensor::calibrated>("calibrated", "", "the positions are angles of the arm"),
            method<&JointSensor::calibrate>("calibrate", "joint 1 to 6, and its angle in rad; ignored beyond 10000"),
            method<&JointSensor::is_calibrated>("is_calibrated", "whether joint 1 to 6 is calibrated"),
            property<&JointSensor::counts_per_rad>("counts_per_rad", "1/rad", "negative: it counts the other way", range(-1e9, 1e9)),
            property<&JointSensor::absolute>("absolute", "", "the encoders know their zero"));
    }
    // clang-format on

private:
    static constexpr unsigned all = 0b111111;
    /// Returns true for a plausible angle: no joint turns nearly this far.
    static constexpr bool is_angle(double angle) noexcept { return std::abs(angle) <= 1e4; }
    std::array<UnwrappedCount, 6> counts_{};
    Joints zero_ = Joints::Zero(), seen_ = Joints::Zero();
    Time seen_at_{};
    unsigned known_ = 0;
    bool has_seen_ = false;
};

/// Effector: sends rates of six joints to drives that take volts, within the arm's limits of rate and
/// acceleration. A rate that is not a number becomes a standstill. Real-time.
struct JointEffector {
    Input<Joints> wanted;
    Output<Joints> sent;
    Output<double> volts_1, volts_2, volts_3, volts_4, volts_5, volts_6;
    Output<bool> enable, release;
    Property<Joints> volts_per_rate{Joints::Ones()};
    Property<double> most_rate{0.5}, most_acceleration{4.0};

    void start(const Cycle&) noexcept TAPPET_REALTIME {
        has_power_ = false;
        put(Joints::Zero());
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        const Joints asked = wanted.get();
        const Joints before = sent.last();
        const double most_change = most_acceleration.get() * to_seconds(cycle.period);
        Joints rates;
        for (int i = 0; i < 6; ++i) {
            double rate = asked[i] == asked[i] && has_power_ ? asked[i] : 0.0;
            rate = std::clamp(rate, -most_rate.get(), most_rate.get());
            rate = has_power_ ? std::clamp(rate, before[i] - most_change, before[i] + most_change) : 0.0;
            rates[i] = rate;
        }
        put(rates);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        has_power_ = false;
        put(Joints::Zero());
    }
    bool power_on() noexcept TAPPET_REALTIME { return has_power_ = true; }
    bool power_off() noexcept TAPPET_REALTIME {
        has_power_ = false;
        return true;
    }

    // clang-format off
    static constexpr auto interface() {
        return facets(
            input<&JointEffector::wanted>("wanted", "rad/s", "of the joints"),
            output<&JointEffector::sent>("sent", "rad/s", "to the drives, within the limits"),
            output<&JointEffector::volts_1>("volts_1", "V", "to the drive"), output<&JointEffector::volts_2>("volts_2", "V", "to the drive"),
            output<&JointEffector::volts_3>("volts_3", "V", "to the drive"), output<&JointEffector::volts_4>("volts_4", "V", "to the drive"),
            output<&JointEffector::volts_5>("volts_5", "V", "to the drive"), output<&JointEffector::volts_6>("volts_6", "V", "to the drive"),
            output<&JointEffector::enable>("enable", "", "of the drives"),
            output<&JointEffector::release>("release", "", "of the brakes"),
            command<&JointEffector::power_on>("power_on", "drives enabled, brakes released"),
            command<&JointEffector::power_off>("power_off", "rates 0, brakes on"),
            property<&JointEffector::volts_per_rate>("volts_per_rate", "V.s/rad", "negative: it turns the other way", range(-20.0, 20.0)),
            property<&JointEffector::most_rate>("most_rate", "rad/s", "of each joint", range(0.0, 0.5)),
            property<&JointEffector::most_acceleration>("most_acceleration", "rad/s^2", "of each joint", range(0.1, 20.0)));
    }
    // clang-format on

private:
    void put(const Joints& rates) noexcept TAPPET_REALTIME {
        const std::array<Output<double>*, 6> outputs{&volts_1, &volts_2, &volts_3,
                                                     &volts_4, &volts_5, &volts_6};
        for (int i = 0; i < 6; ++i)
            outputs[static_cast<std::size_t>(i)]->write(rates[i] * volts_per_rate.get()[i]);
        sent.write(rates);
        enable.write(has_power_);
        release.write(has_power_);
    }

    bool has_power_ = false;
};

} // namespace two_robots
