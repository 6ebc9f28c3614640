// Lines and arcs: their end points, twists as derivatives of their frames, and limits.
#include "kernel/motion/path.hpp"
#include "kernel/motion/trajectory.hpp"
#include "tests/kernel/base/seeded.hpp"
#include "tests/kernel/motion/random_motion.hpp"

#include <cmath>

namespace tappet::motion::test {
namespace {

struct World;
struct Tool;
using Place = Frame<World, Tool>;
using Way = Path<World, Tool>;
using tappet::test::no_number;

struct Paths : tappet::test::Seeded {
    void expect_leads(const Way& way, const Place& from, const Place& to) {
        for (const auto& [share, place] : {std::pair{0.0, from}, std::pair{1.0, to}}) {
            const auto there = way.at({share, 0.0, 0.0}).frame;
            EXPECT_NEAR((there.position - place.position).norm(), 0.0, 1e-11) << share;
            EXPECT_NEAR((there.rotation - place.rotation).norm(), 0.0, 1e-12) << share;
        }
    }
    /// Computed by differences over a motion of any rate and change.
    void expect_is_derived(const Way& way) {
        const double s0 = random.unit();
        const double rate = within(random, 1.0);
        const double change = within(random, 1.0);
        const auto at = [&](double t) {
            return way.at({s0 + rate * t + 0.5 * change * t * t, rate + change * t, change});
        };
        const double h = 1e-5;
        const auto now = at(0.0);
        const auto moved = difference(at(-h).frame, at(h).frame);
        const double size = 1.0 + way.length_m() * (1.0 + way.length_m());
        EXPECT_NEAR((now.velocity.linear - moved.linear / (2 * h)).norm(), 0.0, 1e-6 * size);
        EXPECT_NEAR((now.velocity.angular - moved.angular / (2 * h)).norm(), 0.0, 1e-6);
        const Eigen::Vector3d faster = (at(h).velocity.linear - at(-h).velocity.linear) / (2 * h);
        const Eigen::Vector3d turning = (at(h).velocity.angular - at(-h).velocity.angular) / (2 * h);
        EXPECT_NEAR((now.acceleration.linear - faster).norm(), 0.0, 1e-6 * size);
        EXPECT_NEAR((now.acceleration.angular - turning).norm(), 0.0, 1e-6);
    }
};

TEST_F(Paths, connect_two_points_in_a_straight_line) {
    for (int round = 0; round < 100; ++round) {
        const auto from = any_frame<World, Tool>(random);
        const auto to = any_frame<World, Tool>(random);
        const auto way = Way::line(from, to);
        ASSERT_TRUE(way);
        expect_leads(*way, from, to);
        expect_is_derived(*way);
        EXPECT_DOUBLE_EQ(way->length_m(), (to.position - from.position).norm());
        const Eigen::Vector3d middle = way->at({0.5, 0.0, 0.0}).frame.position;
        EXPECT_NEAR((middle - 0.5 * (from.position + to.position)).norm(), 0.0, 1e-14);
    }
}

TEST_F(Paths, along_an_arc_pass_through_the_via_point) {
    for (int round = 0; round < 100; ++round) {
        // A circle with known points, in any plane.
        const auto plane = any_frame<World, Tool>(random);
        const double radius = 0.1 + random.unit();
        const double end = 0.2 + 6.0 * random.unit();
        const double between = end * (0.2 + 0.6 * random.unit());
        const auto on_circle = [&](double angle) -> Eigen::Vector3d {
            return plane.rotation * Eigen::Vector3d{radius * std::cos(angle), radius * std::sin(angle), 0.0} +
                   plane.position;
        };
        auto from = any_frame<World, Tool>(random);
        auto to = any_frame<World, Tool>(random);
        from.position = on_circle(0.0);
        to.position = on_circle(end);
        const auto way = Way::arc(from, Point<World>{on_circle(between)}, to);
        ASSERT_TRUE(way);
        EXPECT_NEAR(way->radius_m(), radius, 1e-9);
        EXPECT_NEAR(way->length_m(), radius * end, 1e-9);
        const double share = between / end;
        EXPECT_NEAR((way->at({share, 0.0, 0.0}).frame.position - on_circle(between)).norm(), 0.0, 1e-9);
        expect_leads(*way, from, to);
        expect_is_derived(*way);
    }
}

TEST_F(Paths, are_followed_within_their_limits) {
    const PathLimits most{{0.5, 2.0, 20.0}, {1.0, 4.0, 40.0}};
    for (int round = 0; round < 50; ++round) {
        const auto from = any_frame<World, Tool>(random);
        const auto to = any_frame<World, Tool>(random);
        const bool bends = random.one_in(2);
        const auto way =
            bends ? Way::arc(from, Point<World>{any_vector(random, 2.0)}, to) : Way::line(from, to);
        ASSERT_TRUE(way);
        const auto limits = way->limits(most);
        ASSERT_TRUE(limits);
        const auto plan = jerk_limited(0.0, 1.0, *limits);
        ASSERT_TRUE(plan);
        for (int i = 0; i <= 200; ++i) {
            const auto state = way->at(plan->at_s(i / 200.0 * plan->duration_s()));
            EXPECT_LE(state.velocity.linear.norm(), most.linear.velocity * (1 + 1e-9));
            EXPECT_LE(state.velocity.angular.norm(), most.angular.velocity * (1 + 1e-9));
            EXPECT_LE(state.acceleration.linear.norm(), most.linear.acceleration * (1 + 1e-9));
            EXPECT_LE(state.acceleration.angular.norm(), most.angular.acceleration * (1 + 1e-9));
        }
        expect_leads(*way, from, to);
    }
}

TEST_F(Paths, are_refused_when_their_shape_is_undetermined) {
    const auto from = any_frame<World, Tool>(random);
    auto to = any_frame<World, Tool>(random);
    const Refused open{Refusal::no_direction};
    EXPECT_EQ(Way::arc(from, Point<World>{0.5 * (from.position + to.position)}, to).error(), open)
        << "on a line";
    EXPECT_EQ(Way::arc(from, Point<World>{from.position}, to).error(), open);
    EXPECT_EQ(Way::arc(from, Point<World>{{9, 9, 9}}, from).error(), open);
    EXPECT_EQ(Way::line(from, from)->limits({{1, 1, 1}, {1, 1, 1}}).error(), open);
    EXPECT_EQ(Way::line(from, to)->limits({{1, 1, 1}, {1, 0, 1}}).error(),
              (Refused{Refusal::limit_not_positive, 1}));
    to.position.y() = no_number;
    EXPECT_EQ(Way::line(from, to).error(), Refused{Refusal::not_a_number});
    EXPECT_EQ(Way::arc(from, Point<World>{{1, 2, 3}}, to).error(), Refused{Refusal::not_a_number});
}

} // namespace
} // namespace tappet::motion::test
