// The controllers of the press: one axis under a position and a velocity loop, or controlled by the force
// error. Down is positive.
#pragma once

#include "kernel/component/component.hpp"
#include "kernel/motion/estimators.hpp"
#include "kernel/motion/trajectory.hpp"
#include "kernel/pieces/hand_over.hpp"
#include "kernel/pieces/ramp.hpp"

#include <algorithm>
#include <cmath>

namespace bearing_press {

using namespace tappet;

inline constexpr motion::AxisLimits slide{.velocity = 0.2, .acceleration = 2.0, .jerk = 40.0}; // m, s

/// The highest speed of the drive, m/s. Each path asks for less.
inline constexpr double fastest = 0.25;
/// Returns a speed within the drive's limits; 0 when `speed` is not a number. A loop that takes over starts
/// from the last sent value, and somebody may have forced that value.
constexpr double speed_of_drive(double speed) noexcept TAPPET_REALTIME {
    return is_number(speed) ? std::clamp(speed, -fastest, fastest) : 0.0;
}

/// Estimator: the velocity of the slide.
struct Speed {
    Input<double> position;
    Output<double> velocity;
    void start(const Cycle&) noexcept TAPPET_REALTIME {
        filter_ = motion::AlphaBeta{gains};
        velocity.write(0.0);
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        filter_.sample(position.get(), cycle.release);
        velocity.write(filter_.velocity());
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { velocity.write(0.0); }
    static constexpr auto interface() {
        return facets(input<&Speed::position>("position", "m", "of the slide"),
                      output<&Speed::velocity>("velocity", "m/s", "of the slide"));
    }

private:
    static constexpr auto gains = motion::AlphaBetaGains::critically_damped(0.7);
    motion::AlphaBeta filter_{gains};
};

/// Generator: the set point is the slide's own position; for a drive without power.
struct Idle {
    Input<double> position;
    Output<double> target, speed;
    void start(const Cycle& cycle) noexcept TAPPET_REALTIME { step(cycle); }
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        target.write(position.get());
        speed.write(0.0);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { speed.write(0.0); }
    static constexpr auto interface() {
        return facets(input<&Idle::position>("position", "m", "of the slide"),
                      output<&Idle::target>("target", "m", "equal to the position"),
                      output<&Idle::speed>("speed", "m/s", "always 0"));
    }
};

/// Generator: brakes from any speed to rest and stays there.
struct Standing {
    Input<double> position, sent;
    Output<double> target, speed;
    void start(const Cycle& cycle) noexcept TAPPET_REALTIME {
        began_ = cycle.now;
        const motion::AxisState from{.position = position.get(), .velocity = speed_of_drive(sent.get())};
        profile_ = motion::stop(from, slide).value_or(motion::Profile{{.position = from.position}});
        step(cycle);
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        if (!is_number(profile_.end().position)) profile_ = motion::Profile{{.position = position.get()}};
        const motion::AxisState next = profile_.at(cycle.now - began_);
        target.write(next.position);
        speed.write(next.velocity);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { speed.write(0.0); }
    static constexpr auto interface() {
        return facets(input<&Standing::position>("position", "m", "of the slide"),
                      input<&Standing::sent>("sent", "m/s", "to the drive in the step before"),
                      output<&Standing::target>("target", "m", "the next place"),
                      output<&Standing::speed>("speed", "m/s", "speed of the target"));
    }

private:
    motion::Profile profile_;
    Time began_{};
};

/// Generator: keeps a constant speed until another generator takes over.
struct Jogging {
    Input<double> position, sent;
    Output<double> target, speed;
    void start(const Cycle&) noexcept TAPPET_REALTIME {
        wanted_ = 0.0;
        put(position.get(), speed_of_drive(sent.get()));
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        const double h = to_seconds(cycle.period);
        const double now =
            speed_ + std::clamp(wanted_ - speed_, -slide.acceleration * h, slide.acceleration * h);
        const double place = at_ + now * h;
        put(is_number(place) ? place : position.get(), is_number(now) ? now : 0.0);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { speed.write(0.0); }
    void at(double wanted) noexcept TAPPET_REALTIME {
        wanted_ = std::clamp(wanted, -slide.velocity, slide.velocity);
    }
    static constexpr auto interface() {
        return facets(input<&Jogging::position>("position", "m", "of the slide"),
                      input<&Jogging::sent>("sent", "m/s", "to the drive in the step before"),
                      output<&Jogging::target>("target", "m", "the next place"),
                      output<&Jogging::speed>("speed", "m/s", "speed of the target"),
                      operation<&Jogging::at>("at", "speed, m/s"));
    }

private:
    void put(double place, double now) noexcept TAPPET_REALTIME {
        target.write(at_ = place);
        speed.write(speed_ = now);
    }
    double at_ = 0.0, speed_ = 0.0, wanted_ = 0.0;
};

/// Generator: moves from rest to a position with bounded jerk.
struct Path {
    Input<double> position;
    Output<double> target, speed;
    Event<> arrived;
    void start(const Cycle& cycle) noexcept TAPPET_REALTIME {
        profile_ = motion::Profile{{.position = position.get()}};
        is_under_way_ = false;
        step(cycle);
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        if (begins_) began_ = cycle.now;
        begins_ = false;
        if (!is_number(profile_.end().position)) profile_ = motion::Profile{{.position = position.get()}};
        const motion::AxisState next = profile_.at(cycle.now - began_);
        target.write(next.position);
        speed.write(next.velocity);
        if (!is_under_way_ || std::abs(position.get() - profile_.end().position) > 20e-6) return;
        is_under_way_ = false;
        arrived.emit();
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { speed.write(0.0); }
    /// Plans a path from rest to `place`. Ignored while another path is under way.
    void aim(double place) noexcept TAPPET_REALTIME {
        const auto planned = motion::jerk_limited(target.last(), place, slide);
        if (is_under_way_ || !planned) return;
        profile_ = *planned;
        is_under_way_ = begins_ = true;
    }
    static constexpr auto interface() {
        return facets(
            input<&Path::position>("position", "m", "of the slide"),
            output<&Path::target>("target", "m", "the next place"),
            output<&Path::speed>("speed", "m/s", "speed of the target"),
            event<&Path::arrived>("arrived", "the slide is at the end of its path, within 20 um"),
            operation<&Path::aim>("aim", "moves to this position in m; ignored while a path is under way"));
    }

private:
    motion::Profile profile_;
    Time began_{};
    bool is_under_way_ = false, begins_ = false;
};

/// Position controller: proportional, with the path's speed fed forward.
struct Place {
    Input<double> target, speed, position, sent;
    Output<double> velocity;
    Property<double> kp{20.0};
    void start(const Cycle&) noexcept TAPPET_REALTIME {
        velocity.write(take_over_.begin(sent.get(), wanted(), fastest));
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        velocity.write(take_over_(wanted(), kp.get() * to_seconds(cycle.period)));
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { velocity.write(0.0); }
    static constexpr auto interface() {
        return facets(input<&Place::target>("target", "m", "the next place"),
                      input<&Place::speed>("speed", "m/s", "of the target"),
                      input<&Place::position>("position", "m", "of the slide"),
                      input<&Place::sent>("sent", "m/s", "to the drive in the step before"),
                      output<&Place::velocity>("velocity", "m/s", "wanted"),
                      property<&Place::kp>("kp", "1/s", "speed for a metre of error", range(1.0, 80.0)));
    }

private:
    [[nodiscard]] double wanted() noexcept TAPPET_REALTIME {
        const double all = speed.get() + kp.get() * (target.get() - position.get());
        if (all != all) return 0.0;
        return std::clamp(all, -fastest, fastest); // a far place may make the sum not-a-number
    }
    HandOver take_over_;
};

/// Generator and Controller of force in one: moves down at a speed proportional to the missing force.
struct Approach {
    Input<double> position;
    Output<double> target;
    Property<double> force{2000.0};
    void start(const Cycle&) noexcept TAPPET_REALTIME { target.write(force.get()); }
    void step(const Cycle&) noexcept TAPPET_REALTIME { target.write(force.get()); }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { target.write(0.0); }
    static constexpr auto interface() {
        return facets(input<&Approach::position>("position", "m", "of the slide"),
                      output<&Approach::target>("target", "N", "to press with"),
                      property<&Approach::force>("force", "N", "at which a bearing counts as seated",
                                                 range(100.0, 5000.0)));
    }
};

/// Force controller: commands a velocity proportional to the missing force.
struct Press {
    Input<double> target, force, sent;
    Output<double> velocity;
    Event<> seated;
    Property<double> kf{1e-5};
    void start(const Cycle&) noexcept TAPPET_REALTIME {
        since_ = never;
        velocity.write(speed_of_drive(sent.get()));
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        const double lacking = target.get() - force.get();
        velocity.write(std::clamp(kf.get() * lacking, -slide.velocity, slide.velocity));
        if (!(std::abs(lacking) <= 0.02 * target.get())) // also true for not-a-number
            since_ = never;
        else if (since_ == never)
            since_ = cycle.now;
        else if (cycle.now - since_ >= 100ms)
            seated.emit(), since_ = never;
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { velocity.write(0.0); }
    static constexpr auto interface() {
        return facets(
            input<&Press::target>("target", "N", "to press with"),
            input<&Press::force>("force", "N", "measured"),
            input<&Press::sent>("sent", "m/s", "to the drive in the step before"),
            output<&Press::velocity>("velocity", "m/s", "wanted"),
            event<&Press::seated>("seated", "the force is within 2 % for 100 ms"),
            property<&Press::kf>("kf", "m/s/N", "speed for one newton of missing force", range(1e-7, 2e-5)));
    }

private:
    Time since_ = never;
};

/// Generator of the inner level: follows the outer level's command within twice the slide's acceleration.
struct Ramp {
    Input<double> command, sent;
    Output<double> target;
    void start(const Cycle&) noexcept TAPPET_REALTIME {
        ramp_.reset(speed_of_drive(sent.get()));
        target.write(ramp_.value());
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        const double asked =
            command.get(); // clamped below: a ramp beyond the drive's speed takes time to return
        target.write(ramp_(is_number(asked) ? speed_of_drive(asked) : asked, cycle.period));
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { target.write(0.0); }
    static constexpr auto interface() {
        return facets(input<&Ramp::command>("command", "m/s", "of the outer level"),
                      input<&Ramp::sent>("sent", "m/s", "to the drive in the step before"),
                      output<&Ramp::target>("target", "m/s", "the next speed"));
    }

private:
    tappet::Ramp ramp_{2.0 * slide.acceleration};
};

/// Controller of the inner level: the target speed plus the integrated speed error of the drive. It does not
/// integrate what the Effector cut off.
struct Trim {
    Input<double> target, velocity, sent;
    Output<double> wanted;
    Property<double> ki{2.0};
    void start(const Cycle&) noexcept TAPPET_REALTIME {
        sum_ = 0.0;
        wanted.write(speed_of_drive(sent.get()));
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        const double now = wanted.last();
        const double more = ki.get() * (target.get() - velocity.get()) * to_seconds(cycle.period);
        if (sent.get() == now && is_number(more)) sum_ = std::clamp(sum_ + more, -most, most);
        wanted.write(target.get() + sum_);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { wanted.write(0.0); }
    static constexpr auto interface() {
        return facets(input<&Trim::target>("target", "m/s", "the next speed"),
                      input<&Trim::velocity>("velocity", "m/s", "of the slide"),
                      input<&Trim::sent>("sent", "m/s", "to the drive in the step before"),
                      output<&Trim::wanted>("wanted", "m/s", "of the drive"),
                      property<&Trim::ki>("ki", "1/s", "integral gain on the speed error", range(0.0, 10.0)));
    }

private:
    static constexpr double most = 0.01; // m/s
    double sum_ = 0.0;
};

} // namespace bearing_press
