// An arm at the other end of its robot's wires: six axes with lagging drives, brakes, encoders and switches,
// and somebody who presses its buttons.
#pragma once

#include "apps/two_robots/values.hpp"
#include "apps/two_robots/wires.hpp"
#include "drivers/can/far_end.hpp"
#include "drivers/gpio/far_end.hpp"
#include "drivers/instruments/simulated.hpp"
#include "drivers/plant/plant.hpp"
#include "kernel/base/digest.hpp"
#include "kernel/base/random.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace two_robots {

/// The properties of an arm that its simulation needs.
struct ArmFacts {
    std::span<const double, 6> counts_per_rad, volts_per_rate, switch_angles, lowest, highest;
    bool absolute; ///< encoders
};

/// Not real-time.
class ArmPlant : public Plant {
public:
    static constexpr double drive_lag_s = 0.010, brake_lag_s = 0.005;
    static constexpr double repeatability = 0.5e-3; ///< rad: of a switch, in both directions
    static constexpr double to_buffers = 0.01;      ///< rad: from a joint's limit to its buffer

    ArmPlant(std::uint64_t seed, const ArmFacts& facts, const Joints& at)
        : facts_{facts}, random_{seed}, at_{at} {
        for (int i = 0; i < 6; ++i)
            encoders_.emplace_back(facts.counts_per_rad[static_cast<std::size_t>(i)],
                                   facts.absolute ? 0.0 : at[i]);
        can.send_every("encoders_a", servo_period);
        can.send_every("encoders_b", servo_period);
        can.send_every("encoders_c", servo_period);
    }

    /// Returns the true joint angles.
    [[nodiscard]] const Joints& joints() const { return at_; }
    [[nodiscard]] const Joints& rates() const { return rate_; }
    [[nodiscard]] const Joints& worst_rates() const { return worst_rate_; }
    [[nodiscard]] double worst_change() const { return worst_change_; } ///< rad/s2 of the commanded rates
    [[nodiscard]] bool brakes_are_on() const { return !released_; }
    [[nodiscard]] bool stands() const { return rate_.cwiseAbs().maxCoeff() < 1e-4; }
    /// Returns how far a joint pressed into a buffer, rad; 0: none did.
    [[nodiscard]] double beyond() const { return beyond_; }

    // ---- for tests and stories: actions of people, and faults
    void press(std::string_view button, Time until) { pressed_ = {button, until}; }
    void jam(int axis) { jammed_ = axis; }
    void forget_worst() {
        worst_rate_ = Joints::Zero();
        worst_change_ = 0.0;
    }

    [[nodiscard]] std::uint64_t digest() const override {
        Digest digest;
        for (int i = 0; i < 6; ++i) digest.add(std::bit_cast<std::uint64_t>(at_[i]));
        return digest.value();
    }

protected:
    void move_arm(Time now) {
        const double h = to_seconds(step());
        const Joints asked = asked_volts();
        const bool runs = io.get("enable") && io.get("release");
        released_ = io.get("release");
        for (int i = 0; i < 6; ++i) {
            const auto at = static_cast<std::size_t>(i);
            const double wanted = runs && jammed_ != i + 1 ? asked[i] / facts_.volts_per_rate[at] : 0.0;
            const double before = rate_[i];
            // The drive's lag, solved for a constant command over the step.
            const double keeps = std::exp(-h / (released_ ? drive_lag_s : brake_lag_s));
            rate_[i] = wanted + (before - wanted) * keeps;
            at_[i] +=
                wanted * h + (before - wanted) * (1.0 - keeps) * (released_ ? drive_lag_s : brake_lag_s);
            worst_rate_[i] = std::max(worst_rate_[i], std::abs(rate_[i]));
            if (h > 0.0) worst_change_ = std::max(worst_change_, std::abs(rate_[i] - before) / h);
            beyond_ = std::max(
                {beyond_, facts_.lowest[at] - to_buffers - at_[i], at_[i] - facts_.highest[at] - to_buffers});
        }
        give_encoders();
        give_switches();
        for (const auto button : {"start", "ready", "work", "stop"})
            set_button(button, pressed_.button == button && now < pressed_.until);
    }

    Random& random() { return random_; }

private:
    can::FarEnd<robot_signals> can{ends, "robot-can"};
    gpio::FarEnd<robot_lines> io{ends, "robot-io"};

    struct Pressed {
        std::string_view button{};
        Time until{};
    };

    [[nodiscard]] Joints asked_volts() const {
        return {can.get("drives_a.joint_1"), can.get("drives_a.joint_2"), can.get("drives_a.joint_3"),
                can.get("drives_b.joint_4"), can.get("drives_b.joint_5"), can.get("drives_b.joint_6")};
    }
    void give_encoders() {
        const auto count = [this](std::size_t i) { return encoders_[i].count(at_[static_cast<int>(i)]); };
        can.set_integer("encoders_a.joint_1", count(0));
        can.set_integer("encoders_a.joint_2", count(1));
        can.set_integer("encoders_b.joint_3", count(2));
        can.set_integer("encoders_b.joint_4", count(3));
        can.set_integer("encoders_c.joint_5", count(4));
        can.set_integer("encoders_c.joint_6", count(5));
    }
    /// Each time a joint passes its switch, the switching angle changes slightly.
    void give_switches() {
        for (std::size_t i = 0; i < 6; ++i) {
            const double edge = facts_.switch_angles[i] + offset_[i];
            const bool active = at_[static_cast<int>(i)] >= edge;
            if (active == is_active_[i]) continue;
            is_active_[i] = active;
            offset_[i] = repeatability * (2.0 * random_.unit() - 1.0);
        }
        io.set("switch_1", is_active_[0]);
        io.set("switch_2", is_active_[1]);
        io.set("switch_3", is_active_[2]);
        io.set("switch_4", is_active_[3]);
        io.set("switch_5", is_active_[4]);
        io.set("switch_6", is_active_[5]);
    }
    void set_button(std::string_view button, bool pressed) {
        if (button == "start") io.set("start", pressed);
        if (button == "ready") io.set("ready", pressed);
        if (button == "work") io.set("work", pressed);
        if (button == "stop") io.set("stop", pressed);
    }

    ArmFacts facts_;
    Random random_;
    Joints at_, rate_ = Joints::Zero(), worst_rate_ = Joints::Zero();
    std::vector<instruments::SimulatedEncoder<32>> encoders_;
    std::array<double, 6> offset_{};
    std::array<bool, 6> is_active_{};
    Pressed pressed_{};
    int jammed_ = 0;
    bool released_ = false;
    double worst_change_ = 0.0, beyond_ = 0.0;
};

} // namespace two_robots
