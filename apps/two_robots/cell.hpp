// The geometry around the two robots, and the camera that looks at the body: simulated, for plants.
#pragma once

#include "apps/two_robots/kinematics.hpp"
#include "apps/two_robots/tool/camera.hpp"
#include "apps/two_robots/tool/replay.hpp"
#include "drivers/udp/far_end.hpp"
#include "kernel/base/random.hpp"
#include "kernel/base/time.hpp"

#include <algorithm>
#include <vector>

namespace two_robots {

inline constexpr double hole_radius = 0.012; ///< m: larger than the body's motion

/// Returns the body in the base frame of the operating robot, for joints `q` of the robot that holds it.
inline BodyFrame body_held_by(const Joints& q) {
    struct BodyRobot;
    motion::Frame<Base, BodyRobot> stands; // placed opposite, facing back
    stands.rotation << -1, 0, 0, 0, -1, 0, 0, 0, 1;
    stands.position << 2.3, 0.0, 0.0;
    K160Kinematics kinematics;
    const FlangeFrame flange = kinematics.posture(SixNumbers{q}).frame();
    const motion::Frame<BodyRobot, Flange> holds{flange.rotation, flange.position};
    motion::Frame<Flange, Body> chest;
    chest.rotation << 0, 0, 1, 0, 1, 0, -1, 0, 0;
    chest.position << 0.0, 0.0, 0.30;
    return stands * holds * chest;
}

/// Returns the tip in the body's frame.
inline BodyTip tip_in_body(const BodyFrame& body, const Joints& q, double tool_length) {
    K361Kinematics kinematics;
    return inverse(body) * kinematics.posture(SixNumbers{q}).frame() * tip_of_tool(tool_length);
}

/// Returns the distance between the centre of the hole and the shaft of a tip inside, m.
inline double shaft_beside_hole(const BodyTip& tip) {
    const Eigen::Vector3d shaft = tip.rotation.col(2);
    const Eigen::Vector3d in_hole = tip.position - shaft * (tip.position.z() / shaft.z());
    return std::sqrt(in_hole.x() * in_hole.x() + in_hole.y() * in_hole.y());
}

/// The 3D camera at 50 Hz, 60 ms late, with noise. Its packets may be lost or overtake each other.
class SimulatedCamera {
public:
    struct Faults {
        std::uint64_t lost_one_in = 50, late_one_in = 100, invalid_one_in = 200;
        double noise_m = 0.05e-3; ///< standard deviation of each coordinate
        bool covered = false;     ///< nothing is seen
        int hidden_led = -1;
    };

    explicit SimulatedCamera(std::uint64_t seed) : random_{seed} {}

    void look(Time now, const BodyFrame& body, udp::FarEnd& link) {
        if (next_ == Time{}) next_ = now;
        for (; next_ <= now; next_ += exposed_every) expose(next_, body);
        const auto is_due = [now](const OnTheWay& each) { return each.arrives <= now; };
        for (const OnTheWay& each : on_the_way_)
            if (is_due(each)) link.send(each.packet);
        std::erase_if(on_the_way_, is_due);
    }

    Faults faults{};
    void restart() { cycle_ = 0; } ///< the count of its exposures restarts

    static constexpr Duration exposed_every = 20ms, least_latency = 60ms, jitter = 4ms;

private:
    using Packet = std::array<std::byte, led_packet::most>;
    struct OnTheWay {
        Time arrives{};
        Packet packet{};
    };

    void expose(Time at, const BodyFrame& body) {
        ++cycle_;
        Leds leds{.cycle = cycle_};
        for (std::size_t i = 0; i < led_count; ++i) {
            const auto& [x, y, z] = leds_on_body[i];
            const motion::Point<Base> place = body * motion::Point<Body>{{x, y, z}};
            for (int axis = 0; axis < 3; ++axis)
                leds.at[i][static_cast<std::size_t>(axis)] = place.at[axis] + faults.noise_m * normal();
            if (static_cast<int>(i) != faults.hidden_led)
                leds.seen = static_cast<std::uint8_t>(leds.seen | 1U << i);
        }
        Duration takes =
            least_latency +
            Duration{static_cast<std::int64_t>(random_.below(static_cast<std::uint64_t>(jitter.count())))};
        if (random_.one_in(faults.late_one_in)) takes += 30ms;
        const bool invalid = random_.one_in(faults.invalid_one_in);
        const bool lost = random_.one_in(faults.lost_one_in);
        if (!lost && !faults.covered) on_the_way_.push_back({at + takes, led_packet::write(leds, invalid)});
    }
    /// Returns a nearly normal number of deviation 1: the sum of twelve uniform ones.
    double normal() {
        double sum = -6.0;
        for (int i = 0; i < 12; ++i) sum += random_.unit();
        return sum;
    }

    Random random_;
    std::uint16_t cycle_ = 0;
    Time next_{};
    std::vector<OnTheWay> on_the_way_;
};

} // namespace two_robots
