// The main shaft: its position between two encoder samples, the events of its angles, and the brake angle,
// which it learns from stop to stop (US4553569).
#pragma once

#include "apps/carpet_loom/cams.hpp"
#include "kernel/cam/estimator.hpp"
#include "kernel/cam/schedule.hpp"
#include "kernel/cam/trust.hpp"
#include "kernel/component/component.hpp"
#include "kernel/component/operation_interface.hpp"
#include "kernel/pieces/changed.hpp"

#include <algorithm>

namespace tappet::carpet {

namespace wires = loom::wires;

/// All real-time, in an activity that each encoder sample wakes.
struct MainShaft {
    Input<std::int64_t> code;
    Output<ShaftMotion> motion;
    Output<double> angle_deg;
    Output<double> speed_rpm;
    Output<bool> valid;
    Output<bool> standing;
    Output<double> stop_error_deg;
    Output<std::int64_t> stops;
    Output<double> brake_distance_deg;
    Event<> beat_up, offer_pattern, weft_opens, weft_closes, window_opens, window_closes;
    Event<> brake_now;
    Event<double> stopped;
    Event<> rests;
    Timer cam_timer;
    Timer brake_timer;
    Timer watch_timer;
    Property<double> stop_angle_deg{wires::nominal::stop_deg};
    Property<double> first_brake_distance_deg{wires::nominal::brake_distance_deg};
    Property<double> learning_rate{0.6};
    Property<double> late_deg{8.0};
    Property<Duration> stamp_latency{0us};

    /// Brakes so that the shaft stops at the stop angle: in this turn if still possible.
    void stop_at_angle() noexcept TAPPET_REALTIME { want_stop(stop_angle_deg.get()); }
    /// The same as a command. Rejected when another component set the brake or the angle is unknown.
    bool stop_shaft(double&) noexcept TAPPET_REALTIME { return want_stop(stop_angle_deg.get()); }
    bool stop_shaft_at(double at_deg, double&) noexcept TAPPET_REALTIME {
        return at_deg >= 0.0 && at_deg < 360.0 && want_stop(at_deg);
    }
    CommandProgress has_stopped(double& error_deg) noexcept TAPPET_REALTIME {
        if (phase_ == Phase::wanted || phase_ == Phase::braking) return CommandProgress::executing;
        if (!reached_) return CommandProgress::failed; // another component set the brake, or it was released
        error_deg = stop_error_deg.last();
        return CommandProgress::done;
    }
    CommandProgress has_stopped_at(double, double& error_deg) noexcept TAPPET_REALTIME {
        return has_stopped(error_deg);
    }
    /// Returns the angle in degrees at a time near the last sample.
    double angle_at(const Time& at) noexcept TAPPET_REALTIME {
        return estimator_.motion().at(at).position.angle().in_degrees();
    }
    /// Forgets a stop, or a brake that holds.
    void release() noexcept TAPPET_REALTIME {
        phase_ = Phase::free;
        brake_timer.cancel();
    }
    /// Another component set the brake (emergency): this stop is not used for learning.
    void brake_was_set() noexcept TAPPET_REALTIME {
        phase_ = Phase::foreign;
        brake_timer.cancel();
    }

    Sentence configure(Setup&) {
        ShaftProperties properties;
        properties.codes_per_turn = wires::encoder_codes_per_turn;
        properties.stamp_latency = stamp_latency.get();
        properties.stamp_jitter = 30us;
        estimator_ = ShaftEstimator{properties};
        deceleration_ = deceleration_for(first_brake_distance_deg.get());
        return check(properties);
    }

    void start(const Cycle& cycle) noexcept TAPPET_REALTIME {
        release();
        trust_.doubt_until(cycle.now + settling);
        angle_deg.write(0.0);
        brake_distance_deg.write(first_brake_distance_deg.get());
        stops.write(0);
        stop_error_deg.write(0.0);
        lose();
    }
    /// The angle is unknown from now on.
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        release();
        lose();
    }

    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        std::int64_t position = 0;
        if (code.read(position) == Flow::fresh)
            estimator_.sample(static_cast<std::uint32_t>(position), code.stamp());
        follow(cycle.now);
    }

    void fire_cams(const Cycle& cycle) noexcept TAPPET_REALTIME {
        schedule_.advance(cycle.now, [this](const CamEvent& event) noexcept TAPPET_REALTIME { fire(event); });
        cam_timer.arm(schedule_.next_due());
    }

    /// Handles the time-out of encoder samples: nothing else would detect it.
    void watch(const Cycle& cycle) noexcept TAPPET_REALTIME { follow(cycle.now); }

    void brake_due(const Cycle& cycle) noexcept TAPPET_REALTIME {
        if (phase_ != Phase::wanted) return;
        brake(cycle.now);
    }

    static constexpr auto interface() {
        return facets(
            input<&MainShaft::code>("code", "", "encoder position, 0..4095 codes a turn"),
            output<&MainShaft::motion>("motion", "", "position, velocity and acceleration with their time"),
            output<&MainShaft::angle_deg>("angle_deg", "deg", "angle now"),
            output<&MainShaft::speed_rpm>("speed_rpm", "rpm", "speed now"),
            output<&MainShaft::valid>("valid", "", "the encoder can be relied on; written on change"),
            output<&MainShaft::standing>("standing", "", "the shaft stands; written on change"),
            output<&MainShaft::stop_error_deg>("stop_error_deg", "deg",
                                               "deviation of the last stop from the wanted angle"),
            output<&MainShaft::stops>("stops", "", "at the stop angle, since start"),
            output<&MainShaft::brake_distance_deg>(
                "brake_distance_deg", "deg", "learned, from the brake's edge to standstill at nominal speed"),
            event<&MainShaft::beat_up>("beat_up", "0 deg: a pick is complete"),
            event<&MainShaft::offer_pattern>("offer_pattern", "the dobby takes the next pattern from now on"),
            event<&MainShaft::weft_opens>("weft_opens",
                                          "the weft's valve must be driven now to open at its angle"),
            event<&MainShaft::weft_closes>("weft_closes", "the weft's valve is no longer needed"),
            event<&MainShaft::window_opens>("window_opens", "from here on the weft may arrive"),
            event<&MainShaft::window_closes>("window_closes", "by here the weft must have arrived"),
            event<&MainShaft::brake_now>(
                "brake_now", "the brake must be driven now to stop at the stop angle", heard_by(3)),
            event<&MainShaft::stopped>("stopped", "the shaft stands after a stop; error in degrees"),
            event<&MainShaft::rests>("rests", "the shaft stands, or its angle is unknown"),
            command<&MainShaft::stop_shaft, &MainShaft::has_stopped>(
                "stop", "stops the shaft at the stop angle; returns the error in degrees",
                for_people(Role::machine_operator)),
            command<&MainShaft::stop_shaft_at, &MainShaft::has_stopped_at>(
                "stop_at", "stops the shaft at this angle in degrees; returns the error in degrees",
                for_people(Role::machine_operator)),
            method<&MainShaft::angle_at>("angle_at", "the angle in degrees at a time near the last sample"),
            operation<&MainShaft::stop_at_angle>("stop_at_angle", "brakes to stand at the stop angle",
                                                 required),
            operation<&MainShaft::release>("release", "forgets the stop", required),
            operation<&MainShaft::brake_was_set>("brake_was_set", "the brake holds, nothing is to be learned",
                                                 required),
            timer<&MainShaft::cam_timer, &MainShaft::fire_cams>("cam_timer", "the next angle event"),
            timer<&MainShaft::brake_timer, &MainShaft::brake_due>("brake_timer", "the brake's edge"),
            timer<&MainShaft::watch_timer, &MainShaft::watch>("watch_timer",
                                                              "when the encoder would be stale"),
            property<&MainShaft::stop_angle_deg>("stop_angle_deg", "deg",
                                                 "harnesses level, least warp tension", range(0, 359.99)),
            property<&MainShaft::first_brake_distance_deg>(
                "first_brake_distance_deg", "deg", "assumed before the first stop; each stop replaces it",
                range(least_distance_deg, most_distance_deg)),
            property<&MainShaft::learning_rate>(
                "learning_rate", "", "weight of the last stop in the learned deceleration", range(0, 1)),
            property<&MainShaft::late_deg>(
                "late_deg", "deg", "up to this far after the brake angle it still brakes in this turn",
                range(0, 90)),
            property<&MainShaft::stamp_latency>("stamp_latency", "s", "of the encoder's frame on the wire",
                                                range(0, 0.01)));
    }

private:
    enum class Phase : std::uint8_t { free, wanted, braking, foreign };
    static constexpr double brake_dead_s = to_seconds(wires::nominal::brake_dead);
    // Range of the brake distance of this loom at nominal speed; the learned distance stays within it.
    static constexpr double least_distance_deg = 30.0;
    static constexpr double most_distance_deg = 180.0;
    static_assert(least_distance_deg > wires::nominal::speed_rpm * 6.0 * brake_dead_s,
                  "during the dead time alone the shaft turns so far");
    // Below this speed the brake bites at once, and the distance says nothing about its torque.
    static constexpr double least_learning_deg_s = 0.5 * wires::nominal::speed_rpm * 6.0;

    /// Returns false when another component set the brake. A stop that has begun keeps its angle.
    bool want_stop(double at_deg) noexcept TAPPET_REALTIME {
        if (phase_ == Phase::foreign || !valid.last()) return false;
        if (phase_ != Phase::free) return true;
        phase_ = Phase::wanted;
        wanted_deg_ = at_deg;
        reached_ = false;
        return true;
    }

    void follow(Time now) noexcept TAPPET_REALTIME {
        schedule_.update(estimator_, now);
        const ShaftState state = estimator_.at(now);
        trust_.watch(estimator_.counters().implausible, now);
        const bool is_valid = estimator_.valid(now) && trust_.believes(now);
        cam_timer.arm(is_valid ? schedule_.next_due() : never);
        watch_timer.arm(is_valid ? estimator_.valid_until() + 1us : never);
        motion.write(estimator_.motion(), estimator_.motion().stamp);
        angle_deg.write(state.position.angle().in_degrees());
        if (is_valid)
            tell(state);
        else
            lose();
        if (!is_valid) return;
        // At standstill, cams close and are judged before the stop is reported: a weft missed here counts.
        if (estimator_.standing() && schedule_.next_due() <= now) fire_cams({.now = now});
        if (phase_ == Phase::wanted) plan_brake(now, state);
        if (phase_ == Phase::braking && estimator_.standing()) finish_stop(state);
        if (phase_ == Phase::foreign && estimator_.standing()) {
            phase_ = Phase::free;
            stopped.emit(error_of(state));
        }
    }

    void tell(const ShaftState& state) noexcept TAPPET_REALTIME {
        speed_rpm.write(state.velocity_deg_s / 6.0);
        valid_.write(valid, true);
        rest(estimator_.standing());
        standing_.write(standing, estimator_.standing());
    }
    /// The position is unknown: no cam fires, open cams are closed, and the reported speed is 0.
    void lose() noexcept TAPPET_REALTIME {
        schedule_.leave_all([this](const CamEvent& event) noexcept TAPPET_REALTIME { fire(event); });
        rest(true);
        speed_rpm.write(0.0);
        valid_.write(valid, false);
        standing_.write(standing, false);
    }
    void rest(bool now) noexcept TAPPET_REALTIME {
        if (now && !resting_) rests.emit();
        resting_ = now;
    }

    void fire(const CamEvent& event) noexcept TAPPET_REALTIME {
        switch (event.row) {
        case beat_up_row: beat_up.emit(); break;
        case offer_pattern_row: offer_pattern.emit(); break;
        case weft_release_row:
            if (event.kind == CamKind::enter)
                weft_opens.emit();
            else
                weft_closes.emit();
            break;
        case arrival_window_row:
            if (event.kind == CamKind::enter)
                window_opens.emit();
            else
                window_closes.emit();
            break;
        default: break;
        }
    }

    /// Returns the deceleration for this brake distance at nominal speed. It excludes the way during the dead
    /// time, in which the shaft turns on.
    [[nodiscard]] static double deceleration_for(double distance_deg) noexcept TAPPET_REALTIME {
        constexpr double speed = wires::nominal::speed_rpm * 6.0;
        return speed * speed / (2.0 * (distance_deg - speed * brake_dead_s));
    }
    [[nodiscard]] double distance_at(double speed_deg_s) const noexcept TAPPET_REALTIME {
        return speed_deg_s * brake_dead_s + speed_deg_s * speed_deg_s / (2.0 * deceleration_);
    }
    [[nodiscard]] double error_of(const ShaftState& state) const noexcept TAPPET_REALTIME {
        return (state.position.angle() - Angle::degrees(wanted_deg_)).in_degrees();
    }

    void plan_brake(Time now, const ShaftState& state) noexcept TAPPET_REALTIME {
        const double speed = std::max(0.0, state.velocity_deg_s);
        if (estimator_.standing()) {
            brake(now);
            return;
        }
        const Angle edge = Angle::degrees(wanted_deg_ - distance_at(speed));
        double ahead = forward_way(state.position.angle(), edge).in_degrees();
        if (ahead > 360.0 - late_deg.get()) ahead = 0.0; // the brake angle was just passed: brake at once
        const Time when =
            ahead == 0.0 ? now : estimator_.when(state.position + Rotation::degrees(ahead), now);
        if (when <= now)
            brake(now);
        else
            brake_timer.arm(when);
    }

    void brake(Time now) noexcept TAPPET_REALTIME {
        const ShaftState state = estimator_.at(now);
        phase_ = Phase::braking;
        edge_ = state.position;
        edge_speed_deg_s_ = state.velocity_deg_s;
        brake_timer.cancel();
        brake_now.emit();
    }

    void finish_stop(const ShaftState& state) noexcept TAPPET_REALTIME {
        phase_ = Phase::free;
        reached_ = true;
        const double distance = (state.position - edge_).in_degrees();
        const double braked = distance - edge_speed_deg_s_ * brake_dead_s;
        if (edge_speed_deg_s_ >= least_learning_deg_s && braked > 1.0) {
            const double seen = edge_speed_deg_s_ * edge_speed_deg_s_ / (2.0 * braked);
            deceleration_ += learning_rate.get() * (seen - deceleration_);
            deceleration_ = std::clamp(deceleration_, deceleration_for(most_distance_deg),
                                       deceleration_for(least_distance_deg));
        }
        brake_distance_deg.write(distance_at(wires::nominal::speed_rpm * 6.0));
        // Saved at halt for the next start. Clamped because of rounding.
        first_brake_distance_deg.set(
            std::clamp(brake_distance_deg.last(), least_distance_deg, most_distance_deg));
        stop_error_deg.write(error_of(state));
        stops.write(stops.last() + 1);
        stopped.emit(error_of(state));
    }

    static constexpr std::size_t beat_up_row = 0, offer_pattern_row = 1, weft_release_row = 2,
                                 arrival_window_row = 3;
    static_assert(cams.rows[beat_up_row].name == "beat_up" &&
                      cams.rows[offer_pattern_row].name == "offer_pattern" &&
                      cams.rows[weft_release_row].name == "weft_release" &&
                      cams.rows[arrival_window_row].name == "arrival_window" && cams.rows.size() == 4,
                  "fire() gives each cam row its event");

    static constexpr Duration settling = 20ms; // after a start: all components see that the angle was lost

    ShaftEstimator estimator_{ShaftProperties{}};
    CamSchedule<cams.size()> schedule_{cams};
    EncoderTrust trust_{};
    Phase phase_ = Phase::free;
    double wanted_deg_ = wires::nominal::stop_deg;
    bool reached_ = false; // the last wanted stop was reached
    ShaftPosition edge_{};
    double edge_speed_deg_s_ = 0.0;
    double deceleration_ = 1.0;
    bool resting_ = true;
    Changed<bool> valid_, standing_;
};

} // namespace tappet::carpet
