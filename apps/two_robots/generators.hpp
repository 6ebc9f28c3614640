// Generators of both robots: set points of the joints from rest, from rates, from paths and from frames.
#pragma once

#include "apps/two_robots/follower.hpp"
#include "kernel/component/component.hpp"
#include "kernel/component/operation_interface.hpp"
#include "kernel/motion/synchronised.hpp"

#include <cmath>

namespace two_robots {

/// The common part of all Generators of joints: start at the joints' positions, at the last sent rates.
struct JointGenerator {
    Input<Joints> positions, sent;
    Output<Joints> target, rate;

protected:
    void put(const Joints& next, const Joints& next_rate) noexcept TAPPET_REALTIME {
        target.write(next);
        rate.write(next_rate);
    }
    template <class Own, class... Facets>
    static constexpr auto joint_facets(const Facets&... more) {
        return facets(input<&Own::positions>("positions", "rad", "of the joints"),
                      input<&Own::sent>("sent", "rad/s", "to the drives in the step before"),
                      output<&Own::target>("target", "rad", "where the joints shall be next"),
                      output<&Own::rate>("rate", "rad/s", "of the joints at the target"), more...);
    }
};

/// The set points are the joints' own positions: for brakes that hold them. Real-time, as all that follow.
struct Idle : JointGenerator {
    void start(const Cycle& cycle) noexcept TAPPET_REALTIME { step(cycle); }
    void step(const Cycle&) noexcept TAPPET_REALTIME { put(positions.get(), Joints::Zero()); }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { rate.write(Joints::Zero()); }
    static constexpr auto interface() { return joint_facets<Idle>(); }
};

/// Brakes from any rate to rest and stays there.
struct Standing : JointGenerator {
    Property<double> acceleration{0.4};

    void start(const Cycle& cycle) noexcept TAPPET_REALTIME {
        follower_.start(positions.get(), sent.get());
        step(cycle);
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        follower_.go(Joints::Zero(), acceleration.get(), to_seconds(cycle.period));
        put(follower_.target(), follower_.rate());
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { rate.write(Joints::Zero()); }
    static constexpr auto interface() {
        return joint_facets<Standing>(property<&Standing::acceleration>(
            "acceleration", "rad/s^2", "with which it brakes", range(0.05, 4.0)));
    }

private:
    FrameFollower follower_;
};

/// Turns joints at requested rates, each joint by itself.
struct Turning : JointGenerator {
    Property<double> acceleration{0.4};

    void start(const Cycle& cycle) noexcept TAPPET_REALTIME {
        wanted_ = Joints::Zero();
        rate_ = sent.get();
        step(cycle);
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        const double most_change = acceleration.get() * to_seconds(cycle.period);
        rate_ += within(wanted_ - rate_, most_change); // each joint by itself
        put(positions.get(), rate_);                   // a counter may be set meanwhile: keeps no position
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { rate.write(Joints::Zero()); }
    void turn(int axis, double rad_per_s) noexcept TAPPET_REALTIME {
        if (axis >= 1 && axis <= 6) wanted_[axis - 1] = std::clamp(rad_per_s, -most, most);
    }
    static constexpr auto interface() {
        return joint_facets<Turning>(
            property<&Turning::acceleration>("acceleration", "rad/s^2", "from rate to rate",
                                             range(0.05, 4.0)),
            method<&Turning::turn>("turn", "turns joint 1 to 6 at this rate from now on, rad/s"));
    }

private:
    static constexpr double most = 0.4;
    Joints wanted_ = Joints::Zero(), rate_ = Joints::Zero();
};

/// Moves from rest to a posture; all joints start and arrive together.
struct JointPath : JointGenerator {
    Property<Joints> ready{Joints::Zero()};
    Property<double> most_rate{0.3}, most_acceleration{0.3}, most_jerk{2.0};

    void start(const Cycle& cycle) noexcept TAPPET_REALTIME {
        path_ = {};
        rest_ = positions.get();
        is_under_way_ = begins_ = false;
        step(cycle);
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        if (begins_) began_ = cycle.now;
        begins_ = false;
        if (!is_under_way_) {
            put(rest_, Joints::Zero());
            return;
        }
        const auto next = path_.at(cycle.now - began_);
        put(next.position, next.velocity);
        rest_ = next.position;
        if (to_seconds(cycle.now - began_) < path_.duration_s()) return;
        is_under_way_ = largest(positions.get() - rest_) > close;
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        is_under_way_ = false;
        rate.write(Joints::Zero());
    }
    bool go(double j1, double j2, double j3, double j4, double j5, double j6) noexcept TAPPET_REALTIME {
        return plan(Joints{j1, j2, j3, j4, j5, j6});
    }
    CommandProgress gone(double, double, double, double, double, double) noexcept TAPPET_REALTIME {
        return arrived();
    }
    bool go_ready() noexcept TAPPET_REALTIME { return plan(ready.get()); }
    CommandProgress arrived() noexcept TAPPET_REALTIME {
        return is_under_way_ ? CommandProgress::executing : CommandProgress::done;
    }
    bool is_ready() noexcept TAPPET_REALTIME { return largest(positions.get() - ready.get()) < 5.0 * close; }
    // clang-format off
    static constexpr auto interface() {
        return joint_facets<JointPath>(
            method<&JointPath::is_ready>("is_ready", "the joints are where work begins"),
            command<&JointPath::go, &JointPath::gone>("go", "moves to these angles in rad; rejected while it moves elsewhere", for_people(Role::machine_operator, moves)),
            command<&JointPath::go_ready, &JointPath::arrived>("go_ready", "to where work begins"),
            property<&JointPath::ready>("ready", "rad", "where work begins", range(-6.3, 6.3)),
            property<&JointPath::most_rate>("most_rate", "rad/s", "of each joint", range(0.01, 0.4)),
            property<&JointPath::most_acceleration>("most_acceleration", "rad/s^2", "of each joint", range(0.05, 4.0)),
            property<&JointPath::most_jerk>("most_jerk", "rad/s^3", "of each joint", range(0.1, 100.0)));
    }
    // clang-format on

private:
    static constexpr double close = 1e-3; // rad
    using Path = motion::Synchronised<6>;

    bool plan(const Joints& to) noexcept TAPPET_REALTIME {
        Path::Limits limits;
        limits.fill({most_rate.get(), most_acceleration.get(), most_jerk.get()});
        const auto planned = Path::plan(rest_, to, limits);
        if (is_under_way_ || !planned) return false;
        path_ = *planned;
        return is_under_way_ = begins_ = true;
    }

    Path path_{};
    Joints rest_ = Joints::Zero();
    Time began_{};
    bool is_under_way_ = false, begins_ = false;
};

/// The common part of all Generators of frames.
struct FrameGenerator : JointGenerator {
    MethodCall<Posture(const SixNumbers&)> posture;
    Property<double> gain{20.0}, most_rate{0.4}, most_acceleration{4.0};

protected:
    void begin() noexcept TAPPET_REALTIME { follower_.start(positions.get(), sent.get()); }
    void follow(const FlangeCommand& command, const Cycle& cycle) noexcept TAPPET_REALTIME {
        follower_.step(posture, command, {gain.get(), most_rate.get(), most_acceleration.get()},
                       to_seconds(cycle.period));
        put(follower_.target(), follower_.rate());
    }
    template <class Own, class... Facets>
    static constexpr auto frame_facets(const Facets&... more) {
        return joint_facets<Own>(
            calls<&Own::posture>("posture", "of the flange for some joints"),
            property<&Own::gain>("gain", "1/s", "on the error of the frame", range(0.0, 50.0)),
            property<&Own::most_rate>("most_rate", "rad/s", "of each joint", range(0.01, 0.4)),
            property<&Own::most_acceleration>("most_acceleration", "rad/s^2", "of each joint",
                                              range(0.05, 10.0)),
            more...);
    }

    FrameFollower follower_;
};

/// Leads the flange as the level above commands.
struct Cartesian : FrameGenerator {
    Input<FlangeCommand> command;

    void start(const Cycle& cycle) noexcept TAPPET_REALTIME {
        begin();
        step(cycle);
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME { follow(command.get(), cycle); }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { rate.write(Joints::Zero()); }
    static constexpr auto interface() {
        return frame_facets<Cartesian>(
            input<&Cartesian::command>("command", "", "where the flange shall be, and its twist there"));
    }
};

/// Twists the flange as requested, along the axes of its base.
struct Twisting : FrameGenerator {
    void start(const Cycle& cycle) noexcept TAPPET_REALTIME {
        wanted_ = {};
        begin();
        step(cycle);
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        // Without an answer the follower has none either, and brakes to a standstill.
        FlangeCommand command{posture(SixNumbers{follower_.target()}).value_or({}).frame(), wanted_};
        follow(command, cycle);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { rate.write(Joints::Zero()); }
    void twist(double x, double y, double z, double rx, double ry, double rz) noexcept TAPPET_REALTIME {
        wanted_ = {{x, y, z}, {rx, ry, rz}};
    }
    static constexpr auto interface() {
        return frame_facets<Twisting>(method<&Twisting::twist>(
            "twist", "twist of the flange from now on: m/s, rad/s, along the base's axes"));
    }

private:
    FlangeTwist wanted_{};
};

/// Simulates a breathing body: the flange moves to and fro around its start position.
struct BodySimulation : FrameGenerator {
    Property<double> stroke{0.010}, frequency{0.25};
    Property<Eigen::Vector3d> direction{Eigen::Vector3d{0, 0, 1}};

    void start(const Cycle& cycle) noexcept TAPPET_REALTIME {
        begin();
        knows_centre_ = false;
        phase_ = 0.0;
        swell_ = 0.0;
        step(cycle);
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        const double h = to_seconds(cycle.period);
        if (!find_centre()) return put(follower_.target(), Joints::Zero());
        const double turn = 2.0 * std::numbers::pi * frequency.get();
        phase_ += turn * h;
        if (phase_ > 2.0 * std::numbers::pi) phase_ -= 2.0 * std::numbers::pi;
        swell_ = std::min(1.0, swell_ + h / swelling_s); // the stroke grows from zero
        const auto [sine, cosine] = motion::sine_cosine(phase_);
        const double reach = 0.5 * stroke.get() * swell_;
        FlangeCommand command{.frame = centre_};
        const Eigen::Vector3d along = direction.get() / std::sqrt(direction.get().dot(direction.get()));
        command.frame.position += reach * sine * along;
        command.twist.linear = reach * turn * cosine * along;
        follow(command, cycle);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { rate.write(Joints::Zero()); }
    static constexpr auto interface() {
        return frame_facets<BodySimulation>(
            property<&BodySimulation::stroke>("stroke", "m", "from end to end", range(0.0, 0.010)),
            property<&BodySimulation::frequency>("frequency", "Hz", "of the breath", range(0.05, 0.5)),
            property<&BodySimulation::direction>("direction", "", "along the base's axes", range(-1.0, 1.0)));
    }
    Sentence accepts(const Proposal& proposal) const noexcept TAPPET_REALTIME {
        const Eigen::Vector3d& wanted = proposal.of(direction);
        if (wanted.dot(wanted) > 0.01) return {};
        return Sentence{"a moving body needs a direction; write one that is not 0"};
    }

private:
    /// Returns false when the flange's posture is unknown.
    [[nodiscard]] bool find_centre() noexcept TAPPET_REALTIME {
        if (knows_centre_) return true;
        const Answer<Posture> now = posture(SixNumbers{follower_.target()});
        centre_ = now.value_or({}).frame();
        return knows_centre_ = now.given();
    }

    static constexpr double swelling_s = 4.0;
    FlangeFrame centre_{};
    bool knows_centre_ = false;
    double phase_ = 0.0, swell_ = 0.0;
};

} // namespace two_robots
