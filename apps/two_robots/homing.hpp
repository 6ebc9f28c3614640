// Process component of a robot with relative encoders: finds the zero of each joint by its switch
// (thesis 3.4.7).
#pragma once

#include "apps/two_robots/values.hpp"
#include "kernel/component/component.hpp"
#include "kernel/component/operation_interface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace two_robots {

/// Commands of all joints may run at once. A joint moves back until its switch is inactive, then creeps
/// forward until it is active, takes the switch's angle as its own, and moves to zero. The command fails when
/// the joint does not move. Real-time, in the activity of the loop.
struct Homing {
    Input<Joints> positions;
    Input<bool> switch_1, switch_2, switch_3, switch_4, switch_5, switch_6;
    Output<bool> homed;
    MethodCall<void(int, double)> turn;
    MethodCall<void(int, double)> calibrate;
    Property<Joints> switch_angles{Joints::Zero()};
    Property<double> rate{0.3}, creep{0.05};
    Property<Duration> moves_within{500ms};

    void start(const Cycle&) noexcept TAPPET_REALTIME {
        axes_ = {};
        homed.write(false);
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        const Joints now = positions.get();
        bool all = true;
        for (int axis = 1; axis <= 6; ++axis) {
            Axis& one = axes_[static_cast<std::size_t>(axis - 1)];
            if (one.phase != Phase::idle) go_on(axis, one, now[axis - 1], cycle.now);
            all &= one.is_homed;
        }
        if (homed.last() != all) homed.write(all);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { axes_ = {}; }

    bool home(std::int64_t axis) noexcept TAPPET_REALTIME {
        if (axis < 1 || axis > 6) return false;
        Axis& one = axes_[static_cast<std::size_t>(axis - 1)];
        if (one.phase != Phase::idle) return false;
        one = {.phase = Phase::begins};
        return true;
    }
    CommandProgress has_homed(std::int64_t axis) noexcept TAPPET_REALTIME {
        const Axis& one = axes_[static_cast<std::size_t>(axis - 1)];
        if (one.phase != Phase::idle) return CommandProgress::executing;
        return one.is_homed ? CommandProgress::done : CommandProgress::failed;
    }
    bool all_homed() const noexcept TAPPET_REALTIME { return homed.last(); }
    /// Forgets all zeros: the joints' angles are unknown from now on. Aborts running homing.
    void forget() noexcept TAPPET_REALTIME { axes_ = {}; }

    // clang-format off
    static constexpr auto interface() {
        return facets(
            input<&Homing::positions>("positions", "rad", "of the joints"),
            input<&Homing::switch_1>("switch_1", "", "active from its angle on"), input<&Homing::switch_2>("switch_2", "", "active from its angle on"),
            input<&Homing::switch_3>("switch_3", "", "active from its angle on"), input<&Homing::switch_4>("switch_4", "", "active from its angle on"),
            input<&Homing::switch_5>("switch_5", "", "active from its angle on"), input<&Homing::switch_6>("switch_6", "", "active from its angle on"),
            output<&Homing::homed>("homed", "", "all joints know their zero"),
            calls<&Homing::turn>("turn", "one joint at a rate"),
            calls<&Homing::calibrate>("calibrate", "sets the angle of a joint"),
            command<&Homing::home, &Homing::has_homed>("home", "joint 1 to 6: finds its switch, then zero; fails when it does not move", for_people(Role::machine_operator, moves)),
            method<&Homing::all_homed>("all_homed", "each joint knows its zero"),
            method<&Homing::forget>("forget", "forgets the zero of every joint and stops homing"),
            property<&Homing::switch_angles>("switch_angles", "rad", "at which the switches become active", range(-3.2, 3.2)),
            property<&Homing::rate>("rate", "rad/s", "to the switch and to zero", range(0.02, 0.4)),
            property<&Homing::creep>("creep", "rad/s", "over the edge of the switch", range(0.005, 0.1)),
            property<&Homing::moves_within>("moves_within", "s", "a joint that does not move within this time fails", range(0.05, 5.0)));
    }
    // clang-format on

private:
    enum class Phase : std::uint8_t { idle, begins, leaves, clears, finds, goes_to_zero };
    struct Axis {
        Phase phase = Phase::idle;
        bool is_homed = false;
        double seen = 0.0; ///< where it last was seen to move
        Time seen_at{};
        double cleared = 0.0;
    };
    static constexpr double clearance = 0.05, moved_enough = 0.002, there = 2e-4; // rad

    [[nodiscard]] bool is_active(int axis) noexcept TAPPET_REALTIME {
        const std::array<Input<bool>*, 6> switches{&switch_1, &switch_2, &switch_3,
                                                   &switch_4, &switch_5, &switch_6};
        return switches[static_cast<std::size_t>(axis - 1)]->get();
    }
    void go_on(int axis, Axis& one, double now, Time time) noexcept TAPPET_REALTIME {
        if (one.phase == Phase::begins || std::abs(now - one.seen) > moved_enough) {
            one.seen = now;
            one.seen_at = time;
        } else if (time - one.seen_at > moves_within.get() && one.phase != Phase::goes_to_zero) {
            end(axis, one, false); // it is jammed, or has no power
            return;
        }
        if (!move(axis, one, now).given()) end(axis, one, false); // the axes were stopped
    }
    /// Runs one step. Returns the answer of the component that moves the axis.
    [[nodiscard]] Answer<void> move(int axis, Axis& one, double now) noexcept TAPPET_REALTIME {
        auto moved = Answer<void>{true};
        switch (one.phase) {
        case Phase::idle: break;
        case Phase::begins: one.phase = Phase::leaves; [[fallthrough]];
        case Phase::leaves:
            moved = turn(axis, -rate.get());
            if (is_active(axis)) break;
            one.phase = Phase::clears;
            one.cleared = now;
            break;
        case Phase::clears: // far enough off the edge to creep over it
            moved = turn(axis, -rate.get());
            if (one.cleared - now > clearance) one.phase = Phase::finds;
            break;
        case Phase::finds: {
            moved = turn(axis, creep.get());
            if (!is_active(axis)) break;
            const double angle = switch_angles.get()[axis - 1];
            moved = calibrate(axis, angle);
            one.seen = angle;
            one.phase = Phase::goes_to_zero;
            break;
        }
        case Phase::goes_to_zero:
            moved = turn(axis, std::clamp(-zero_gain * now, -rate.get(), rate.get()));
            if (std::abs(now) < there) end(axis, one, true);
            break;
        }
        return moved;
    }
    void end(int axis, Axis& one, bool well) noexcept TAPPET_REALTIME {
        static_cast<void>(turn(axis, 0.0)); // a stopped axis stands anyway
        one = {.is_homed = well};
    }

    static constexpr double zero_gain = 2.0; // 1/s
    std::array<Axis, 6> axes_{};
};

} // namespace two_robots
