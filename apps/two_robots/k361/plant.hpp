// The arm that operates, the camera, and the other robot with the body: that machine runs inside this plant,
// at the same time.
#pragma once

#include "apps/two_robots/arm_plant.hpp"
#include "apps/two_robots/cell.hpp"
#include "apps/two_robots/host/record.hpp"
#include "apps/two_robots/joints_link.hpp"
#include "apps/two_robots/k160/plant.hpp"
#include "apps/two_robots/k361/machine.hpp"
#include "apps/two_robots/time_link.hpp"
#include "toolchain/machine/host.hpp"

#include <optional>
#include <string>
#include <vector>

namespace two_robots::k160 {

AcceptedMachine on_host();

} // namespace two_robots::k160

namespace two_robots::k361 {

class Plant final : public ArmPlant {
public:
    static constexpr double tool_length = 0.40;
    static constexpr Duration noted_every = 40ms;

    explicit Plant(std::uint64_t seed) : Plant{seed, Random{seed ^ 0x361}} {}
    ~Plant() override {
        if (body_robot_) body_robot_->stop();
    }

    Time move(Time now) override {
        move_arm(now);
        const BodyFrame body = body_held_by(move_body());
        time_link.carry(now, body_time, body_arm_.time_port);
        camera.look(now, body, camera_link);
        judge(tip_in_body(body, joints(), tool_length));
        now_.body = body.position;
        if (works_by_itself_) work(now);
        return now + 1ms;
    }
    [[nodiscard]] Duration usual_time() const override { return 120s; }
    [[nodiscard]] Sentence fault() const override {
        if (beyond() > 0.0) return Sentence{"a joint was turned beyond its end"};
        if (hit_) return Sentence{"the tip hit the chest beside the hole"};
        if (worst_beside_ > hole_radius) return Sentence{"the shaft left the hole"};
        return body_arm_.fault();
    }
    [[nodiscard]] std::uint64_t digest() const override {
        Digest digest;
        digest.add(ArmPlant::digest());
        digest.add(body_arm_.digest());
        if (body_robot_) digest.add(digest_of(body_robot_->instance(), body_arm_));
        return digest.value();
    }
    void report(JsonText& json) const override {
        json.field("worst_beside_hole_mm", worst_beside_ * 1e3);
        json.field("tip_x_mm", now_.tip.x() * 1e3).field("tip_y_mm", now_.tip.y() * 1e3);
        json.field("tip_z_mm", now_.tip.z() * 1e3).field("body_z_mm", now_.body.z() * 1e3);
    }

    void leave_alone() { works_by_itself_ = false; }
    void forget_worst_shaft() { worst_beside_ = 0.0; }
    /// Returns the present moment, without the states.
    [[nodiscard]] const Moment& now() const { return now_; }
    [[nodiscard]] double worst_beside_hole() const { return worst_beside_; } ///< m
    /// Records a moment for the picture, with the states of both robots.
    void note(std::string_view tool_robot, std::string_view body_robot) {
        moments_.push_back(now_);
        moments_.back().at_s = to_seconds(elapsed());
        moments_.back().tool_robot = tool_robot;
        moments_.back().body_robot = body_robot;
    }
    [[nodiscard]] const std::vector<Moment>& moments() const { return moments_; }
    /// Returns the machine that runs inside this plant.
    [[nodiscard]] VirtualRun& body_robot() {
        if (!body_robot_) {
            const auto started = body_robot_.emplace(k160::on_host(), body_arm_, seed_).start();
            TAPPET_CONTRACT(started.has_value(), Contract::precondition, 0);
        }
        return *body_robot_;
    }
    [[nodiscard]] k160::Plant& body_arm() { return body_arm_; }

    [[nodiscard]] std::string_view usage() const override {
        return "  --picture FILE      draws the run as SVG: tip, shaft in the hole, body, states\n"
               "  --body-at PORT      another program on this box runs the body's robot; its plant sends the "
               "joints to PORT\n";
    }
    bool take_option(std::string_view option, std::string_view value, Sentence& fault) override {
        if (option == "--picture") picture = value;
        if (option == "--body-at") fault = link_.listen(value);
        return option == "--picture" || option == "--body-at";
    }

    SimulatedCamera camera;
    udp::FarEnd camera_link{ends, "camera-link"};
    TimeLink time_link;
    udp::FarEnd body_time{ends, "body-time"};
    std::string picture{}; ///< the file to write; empty: no picture

private:
    Plant(std::uint64_t seed, Random place)
        : ArmPlant{seed, ArmFacts{counts_per_rad, volts_per_rate, switch_angles, lowest, highest, true},
                   [&] {
                       Joints at;
                       for (int i = 0; i < 6; ++i) at[i] = 0.6 * (place.unit() - 0.5);
                       return at;
                   }()},
          camera{seed},
          time_link{seed},
          body_arm_{seed},
          seed_{seed} {}

    /// The shaft is in the hole from where it passes the chest downwards until it comes out again.
    void judge(const BodyTip& tip) {
        const Eigen::Vector3d& at = now_.tip = tip.position;
        const double beside_axis = std::sqrt(at.x() * at.x() + at.y() * at.y());
        const bool is_below = at.z() < 0.0;
        if (is_below && was_above_ && beside_axis < chest_radius) {
            now_.is_inside = beside_axis < hole_radius;
            hit_ |= !now_.is_inside;
        }
        if (!is_below) now_.is_inside = false;
        was_above_ = !is_below;
        now_.beside_hole = now_.is_inside ? shaft_beside_hole(tip) : 0.0;
        worst_beside_ = std::max(worst_beside_, now_.beside_hole);
    }
    /// Moves the arm that holds the body, which runs in here or elsewhere on the box; returns its joints.
    const Joints& move_body() {
        if (link_.listens()) {
            link_.take(told_);
            return told_;
        }
        body_robot().run_for(elapsed() - moved_);
        moved_ = elapsed();
        return body_arm_.joints();
    }
    /// Returns true when the body has been at its operating place for a while, and moves.
    bool breathes(Time now) {
        if ((now_.body - seen_body_).norm() > 1e-3) {
            seen_body_ = now_.body;
            moved_at_ = now;
        }
        if ((now_.body - Eigen::Vector3d{0.75, 0.0, 0.75}).norm() > 0.03) lies_since_ = now;
        return now - lies_since_ > 2s && now - moved_at_ < 1s;
    }
    /// Presses ready as soon as there is power, and work when the body lies in place and breathes.
    void work(Time now) {
        const Duration t = elapsed();
        if (t > 100ms && t < 200ms) press("start", now + 100ms);
        if (!stands()) stood_since_ = now;
        const bool body_breathes = breathes(now);
        if (now - stood_since_ < 1s || t < 2s) return;
        stood_since_ = now;
        if (!ready_pressed_)
            press("ready", now + 100ms);
        else if (body_breathes)
            press("work", now + 100ms);
        ready_pressed_ = true;
    }

    k160::Plant body_arm_;
    std::uint64_t seed_;
    mutable std::optional<VirtualRun> body_robot_;
    JointsLink link_;
    Joints told_ = Joints::Zero();
    Eigen::Vector3d seen_body_{};
    Time lies_since_{}, moved_at_{};
    bool works_by_itself_ = true, ready_pressed_ = false;
    Duration moved_{};
    Time stood_since_{};
    static constexpr double chest_radius = 0.15; // m
    bool was_above_ = false, hit_ = false;
    Moment now_{};
    double worst_beside_ = 0.0;
    std::vector<Moment> moments_;
};

} // namespace two_robots::k361
