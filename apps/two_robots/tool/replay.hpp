// Generator of the tool's loop: leads the tip in the body's frame to the hole, through it, and along a
// recorded path.
#pragma once

#include "apps/two_robots/tool/body_estimator.hpp"
#include "apps/two_robots/tool/recorded_path.hpp"
#include "kernel/component/component.hpp"
#include "kernel/component/operation_interface.hpp"
#include "kernel/motion/path.hpp"
#include "kernel/motion/trajectory.hpp"

#include <atomic>
#include <cstdint>
#include <optional>

namespace two_robots {

inline FlangeTip tip_of_tool(double length) noexcept TAPPET_REALTIME {
    FlangeTip tip;
    tip.position.z() = length;
    return tip;
}

/// Returns the frame of a tip inside whose shaft leads from the hole, the body's origin: for any motion of
/// the tip, the shaft only turns in the hole.
inline BodyTip through_the_hole(const Eigen::Vector3d& tip) noexcept TAPPET_REALTIME {
    const Eigen::Vector3d z = tip / std::sqrt(tip.dot(tip));
    Eigen::Vector3d x = Eigen::Vector3d::UnitX() - z.x() * z;
    x /= std::sqrt(x.dot(x));
    BodyTip frame;
    frame.rotation << x, z.cross(x), z;
    frame.position = tip;
    return frame;
}

/// Without a command its set point is the present tip, so that a controller that takes over starts there.
/// Real-time.
struct Replay {
    Input<Joints> positions;
    Input<BodyModel> model;
    Output<TipSetPoint> set_point;
    Output<std::int64_t> rounds;
    MethodCall<Posture(const SixNumbers&)> posture;
    Property<double> tool_length{0.40}, depth{0.15}, above{0.05}, speed{0.03}, acceleration{0.1}, turn{0.2};
    Property<double> path_speed{1.0};

    void start(const Cycle&) noexcept TAPPET_REALTIME {
        leg_ = Leg::none;
        rounds.write(0);
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        sees_body_.store(model.good(), std::memory_order_relaxed);
        if (!model.good()) {
            leg_ = Leg::none; // without the body's place there is no way to go
            return;
        }
        if (begins_) began_ = cycle.now;
        begins_ = false;
        if (leg_ == Leg::none) {
            if (const auto now = tip_now()) set_point.write({tool_length.get(), *now, {}});
        } else if (leg_ == Leg::path)
            follow_path(to_seconds(cycle.period));
        else
            follow_line(cycle.now);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        leg_ = Leg::none;
        sees_body_.store(false, std::memory_order_relaxed);
    }
    /// Returns true when any Estimator knows the body.
    bool sees_body() const noexcept TAPPET_REALTIME { return sees_body_.load(std::memory_order_relaxed); }

    /// Moves above the hole, into it, and along the path, until the next command.
    bool operate() noexcept TAPPET_REALTIME {
        if (!model.good()) return false;
        // A tip that is already inside does not go out to come in again.
        const auto now = tip_now();
        if (!now) return false;
        const bool is_inside = now->position.z() < -0.5 * depth.get();
        return go(is_inside ? Leg::to_path : Leg::above, *now);
    }
    CommandProgress operates() noexcept TAPPET_REALTIME {
        if (leg_ == Leg::none) return CommandProgress::failed;
        return leg_ == Leg::path ? CommandProgress::done : CommandProgress::executing;
    }
    /// Moves out of the hole.
    bool withdraw() noexcept TAPPET_REALTIME {
        if (!model.good()) return false;
        const auto now = tip_now();
        return now && go(now->position.z() < 0.0 ? Leg::to_axis : Leg::out, *now);
    }
    CommandProgress is_out() noexcept TAPPET_REALTIME {
        if (leg_ != Leg::none) return CommandProgress::executing;
        return is_withdrawn_ ? CommandProgress::done : CommandProgress::failed;
    }

    // clang-format off
    static constexpr auto interface() {
        return facets(
            input<&Replay::positions>("positions", "rad", "of the joints"),
            input<&Replay::model>("model", "", "where the body is"),
            output<&Replay::set_point>("set_point", "", "of the tip in the body's frame, and its twist"),
            output<&Replay::rounds>("rounds", "", "of the path, since the start"),
            calls<&Replay::posture>("posture", "of the flange for some joints"),
            command<&Replay::operate, &Replay::operates>("operate", "into the hole and along the path; done when the path begins"),
            command<&Replay::withdraw, &Replay::is_out>("withdraw", "out of the hole"),
            method<&Replay::sees_body>("sees_body", "it is known where the body is", any_thread),
            property<&Replay::tool_length>("tool_length", "m", "from flange to tip", range(0.05, 1.0)),
            property<&Replay::depth>("depth", "m", "of the path below the hole", range(0.06, 0.25)),
            property<&Replay::above>("above", "m", "the hole: where it comes in from", range(0.01, 0.2)),
            property<&Replay::speed>("speed", "m/s", "of lines", range(0.001, 0.1)),
            property<&Replay::acceleration>("acceleration", "m/s^2", "of lines", range(0.01, 1.0)),
            property<&Replay::turn>("turn", "rad/s", "of lines", range(0.01, 0.4)),
            property<&Replay::path_speed>("path_speed", "", "1: as it was recorded", range(0.0, 2.0)));
    }
    // clang-format on

private:
    enum class Leg : std::uint8_t { none, above, in, to_path, path, to_axis, out };
    using Line = motion::Path<Body, Tip>;

    /// Returns the tip; nothing when the component that knows the flange's posture does not run.
    [[nodiscard]] std::optional<BodyTip> tip_now() noexcept TAPPET_REALTIME {
        const Answer<Posture> flange = posture(SixNumbers{positions.get()});
        if (!flange.given()) return std::nullopt;
        return inverse(model.get().frame) * flange.value_or({}).frame() * tip_of_tool(tool_length.get());
    }
    [[nodiscard]] BodyTip on_axis(double z) const noexcept TAPPET_REALTIME {
        BodyTip frame = through_the_hole({0, 0, -1});
        frame.position = {0, 0, z};
        return frame;
    }
    [[nodiscard]] BodyTip on_path(double at_s) const noexcept TAPPET_REALTIME {
        return through_the_hole(recorded_at(at_s) + Eigen::Vector3d{0, 0, -depth.get()});
    }
    [[nodiscard]] BodyTip end_of(Leg leg) const noexcept TAPPET_REALTIME {
        switch (leg) {
        case Leg::above:
        case Leg::out: return on_axis(above.get());
        case Leg::in:
        case Leg::to_axis: return on_axis(-depth.get());
        default: return on_path(0.0);
        }
    }
    bool go(Leg leg, const BodyTip& from) noexcept TAPPET_REALTIME {
        is_withdrawn_ = false;
        leg_ = Leg::none;
        const auto line = Line::line(from, end_of(leg));
        if (!line) return false;
        const motion::PathLimits most{{speed.get(), acceleration.get(), jerk * acceleration.get()},
                                      {turn.get(), turn.get(), jerk * turn.get()}};
        const auto limits = line->limits(most);
        if (!limits) { // already there
            profile_ = motion::Profile{{.position = 1.0}};
        } else {
            const auto planned = motion::jerk_limited(0.0, 1.0, *limits);
            if (!planned) return false;
            profile_ = *planned;
        }
        line_ = *line;
        leg_ = leg;
        return begins_ = true;
    }
    void follow_line(Time now) noexcept TAPPET_REALTIME {
        const auto next = line_.at(profile_.at(now - began_));
        set_point.write({tool_length.get(), next.frame, next.velocity});
        if (to_seconds(now - began_) < profile_.duration_s()) return;
        if (leg_ == Leg::out) {
            is_withdrawn_ = true;
            leg_ = Leg::none;
        } else if (leg_ == Leg::to_path) {
            leg_ = Leg::path;
            at_s_ = pace_ = 0.0;
        } else if (const Leg after = leg_ == Leg::above ? Leg::in
                                     : leg_ == Leg::in  ? Leg::to_path
                                                        : Leg::out;
                   go(after, next.frame)) {
            begins_ = false;
            began_ = now;
        }
    }
    void follow_path(double h) noexcept TAPPET_REALTIME {
        pace_ += std::clamp(path_speed.get() - pace_, -h, h); // full pace within a second from standstill
        at_s_ += pace_ * h;
        if (at_s_ >= recorded_s) {
            at_s_ -= recorded_s;
            rounds.write(rounds.last() + 1);
        }
        const BodyTip now = on_path(at_s_);
        auto twist = motion::difference(now, on_path(at_s_ + moment_s));
        twist.linear *= pace_ / moment_s;
        twist.angular *= pace_ / moment_s;
        set_point.write({tool_length.get(), now, twist});
    }

    static constexpr double jerk = 5.0;       // 1/s: of the acceleration
    static constexpr double moment_s = 0.001; // step over which a twist is computed
    Leg leg_ = Leg::none;
    Line line_ = *Line::line(BodyTip{}, BodyTip{});
    motion::Profile profile_{};
    Time began_{};
    double at_s_ = 0.0, pace_ = 0.0;
    bool begins_ = false, is_withdrawn_ = false;
    std::atomic<bool> sees_body_{false};
};

} // namespace two_robots
