// For any numbers, a plan respects its limits and is a number at all times, or it is refused.
#include "kernel/motion/axis_mode.hpp"
#include "kernel/motion/path.hpp"
#include "kernel/motion/synchronised.hpp"
#include "tests/kernel/base/hostile.hpp"

namespace tappet::motion {
namespace {

constexpr int rounds = 20'000;
constexpr double instant = 1e-300; // shorter times have few digits and move nothing

struct World;
struct Tool;
using Place = Frame<World, Tool>;
using Way = Path<World, Tool>;

bool all_numbers(const Eigen::Ref<const Eigen::MatrixXd>& m) { return m.allFinite(); }
bool is_whole(const AxisState& state) {
    return is_number(state.position) && is_number(state.velocity) && is_number(state.acceleration);
}

struct Plans : test::Hostile {
    /// Usual values of one axis, or each of any size.
    bool is_usual = random.one_in(2);
    double draw() {
        return is_usual && !random.one_in(20) ? (2.0 * random.unit() - 1.0) * usual_size() : value();
    }

    AxisState any_state() {
        is_usual = random.one_in(2);
        const double position = draw(), velocity = draw();
        return {position, velocity, draw()};
    }
    AxisLimits any_limits() {
        const auto limit = [&] { return random.one_in(20) ? draw() : std::fabs(draw()); };
        const double velocity = limit(), acceleration = limit();
        return {velocity, acceleration, limit()};
    }
    /// The number of plans made; each is checked here for validity.
    int made = 0;
    void expect_whole(const Planned& plan, const AxisState& from, const AxisLimits& most, bool has_jerk) {
        if (!plan) return;
        ++made;
        SCOPED_TRACE(testing::Message() << "from " << from.position << " " << from.velocity << " "
                                        << from.acceleration << " to " << plan->end().position << " within "
                                        << most.velocity << " " << most.acceleration << " " << most.jerk);
        const double end = plan->duration_s();
        ASSERT_TRUE(is_number(end) && end >= 0.0 && is_whole(plan->end()));
        ASSERT_EQ(plan->end().velocity, 0.0);
        for (const double t : {-1.0, 0.0, random.unit() * end, random.unit() * end, random.unit() * end, end,
                               std::nexttoward(end, 0.0), value()}) {
            const AxisState at = plan->at_s(t);
            ASSERT_TRUE(is_whole(at)) << t << " s of " << end;
            const double fastest = std::max(most.velocity, std::fabs(from.velocity));
            const double hardest = std::max(most.acceleration, has_jerk ? std::fabs(from.acceleration) : 0.0);
            ASSERT_LE(std::fabs(at.velocity), 1.001 * fastest + 1e-100 + instant * hardest)
                << t << " s of " << end;
            ASSERT_LE(std::fabs(at.acceleration),
                      1.001 * hardest + 1e-100 + (has_jerk ? instant * most.jerk : 0.0))
                << t << " s of " << end;
        }
        // Just before its end it is at its end position, as precisely as its numbers on the way allow.
        const AxisState last = plan->at_s(std::nexttoward(end, 0.0));
        double far = std::max(std::fabs(from.position), std::fabs(plan->end().position));
        for (int i = 0; i <= 20; ++i) far = std::max(far, std::fabs(plan->at_s(0.05 * i * end).position));
        ASSERT_NEAR(last.position, plan->end().position, 1e-4 * far + 1e-100);
        for (const Duration since : {step(), step(), Duration::max(), Duration::min()})
            ASSERT_TRUE(is_whole(plan->at(since)));
    }
    void TearDown() override { EXPECT_GT(made, rounds / 50) << "else nothing was tested"; }
};

TEST_F(Plans, by_trapezoid_are_valid_or_refused) {
    for (int n = 0; n < rounds; ++n) {
        const AxisState from = any_state();
        const AxisLimits most = any_limits();
        const double target = random.one_in(9) ? from.position : draw();
        ASSERT_NO_FATAL_FAILURE(expect_whole(trapezoid(from, target, most), from, most, false));
    }
}

TEST_F(Plans, of_bounded_jerk_are_valid_or_refused) {
    for (int n = 0; n < rounds; ++n) {
        const AxisState from{any_state().position, 0.0, 0.0};
        const AxisLimits most = any_limits();
        const double target = draw();
        ASSERT_NO_FATAL_FAILURE(expect_whole(jerk_limited(from.position, target, most), from, most, true));
    }
}

TEST_F(Plans, of_a_stop_are_valid_or_refused) {
    for (int n = 0; n < rounds; ++n) {
        const AxisState from = any_state();
        AxisLimits most = any_limits();
        const Planned plan = stop(from, most);
        // It gains speed until its acceleration is zero.
        most.velocity = std::fabs(from.velocity) + from.acceleration / most.jerk * from.acceleration;
        ASSERT_NO_FATAL_FAILURE(expect_whole(plan, from, most, true));
    }
}

TEST_F(Plans, of_synchronised_axes_are_valid_or_refused) {
    for (int n = 0; n < rounds; ++n) {
        is_usual = random.one_in(4);
        Joints<3> from, target;
        Synchronised<3>::Limits most;
        for (int i = 0; i < 3; ++i) {
            from[i] = draw();
            target[i] = draw();
            most[static_cast<std::size_t>(i)] = any_limits();
        }
        const auto plan = Synchronised<3>::plan(from, target, most);
        if (!plan) continue;
        ++made;
        ASSERT_EQ(plan->at_s(plan->duration_s()).position, target);
        for (const double t : {-1.0, 0.0, random.unit() * plan->duration_s(), value()}) {
            const auto at = plan->at_s(t);
            ASSERT_TRUE(all_numbers(at.position) && all_numbers(at.velocity) && all_numbers(at.acceleration));
            for (int i = 0; i < 3; ++i) {
                const AxisLimits& limit = most[static_cast<std::size_t>(i)];
                ASSERT_LE(std::fabs(at.velocity[i]), 1.001 * limit.velocity + 1e-100);
                ASSERT_LE(std::fabs(at.acceleration[i]), 1.001 * limit.acceleration + 1e-100);
            }
        }
    }
}

// ---- paths

struct Ways : test::Hostile {
    /// A rotation at any position; occasionally one of its numbers is any value.
    Place any_place(double size) {
        Place place;
        for (int i = 0; i < 3; ++i) place.position[i] = (2.0 * random.unit() - 1.0) * size;
        const double turn = 6.0 * random.unit() - 3.0;
        place.rotation = rotation_about({turn, 0.5 * turn, random.unit()});
        if (random.one_in(5)) place.position[static_cast<int>(random.below(3))] = value();
        if (random.one_in(20)) place.rotation(static_cast<Eigen::Index>(random.below(9))) = value();
        return place;
    }
    PathLimits any_limits() {
        const auto limits = [&] {
            const double velocity = positive_mostly(), acceleration = positive_mostly();
            return AxisLimits{velocity, acceleration, positive_mostly()};
        };
        const AxisLimits linear = limits();
        return {linear, limits()};
    }
    double positive_mostly() { return random.one_in(5) ? value() : 10.0 * random.unit(); }
};

TEST_F(Ways, through_any_points_are_finite_or_refused) {
    int made = 0;
    for (int n = 0; n < rounds; ++n) {
        const double size = random.one_in(2) ? 1.0 : positive();
        const Place from = any_place(size), to = any_place(size);
        const Place via = any_place(size);
        for (const auto& way : {Way::line(from, to), Way::arc(from, {via.position}, to)}) {
            if (!way) continue;
            ++made;
            ASSERT_TRUE(is_number(way->length_m()) && is_number(way->angle_rad()) &&
                        is_number(way->radius_m()));
            for (const double share : {0.0, random.unit(), 1.0}) {
                const auto at = way->at({share, 2.0 * random.unit() - 1.0, 2.0 * random.unit() - 1.0});
                for (const auto& v : {at.frame.position, at.velocity.linear, at.velocity.angular,
                                      at.acceleration.linear, at.acceleration.angular})
                    ASSERT_TRUE(all_numbers(v)) << "length " << way->length_m() << ", share " << share;
            }
            if (const auto limits = way->limits(any_limits())) {
                for (const double limit : {limits->velocity, limits->acceleration, limits->jerk})
                    ASSERT_TRUE(is_number(limit) && limit > 0.0) << limit;
            }
        }
    }
    EXPECT_GT(made, rounds / 10);
}

TEST_F(Ways, with_invalid_numbers_are_refused) {
    const Place good = any_place(1.0);
    for (const double bad : {test::no_number, test::infinite})
        for (int i = 0; i < 12; ++i) {
            Place place;
            (i < 9 ? place.rotation(i) : place.position[i - 9]) = bad;
            EXPECT_FALSE(Way::line(good, place)) << i;
            EXPECT_FALSE(Way::line(place, good)) << i;
            EXPECT_FALSE(Way::arc(place, {{1.0, 2.0, 3.0}}, good)) << i;
            EXPECT_FALSE(Way::arc(good, {{1.0, 2.0, 3.0}}, place)) << i;
            if (i < 3) {
                Point<World> via{{1.0, 2.0, 3.0}};
                via.at[i] = bad;
                EXPECT_FALSE(Way::arc(good, via, Place{})) << i;
            }
        }
}

TEST(AxisModes, from_any_byte_are_valid_or_refuse_every_command) {
    constexpr std::size_t modes = names_of<AxisMode>.size();
    for (unsigned mode = 0; mode < 256; ++mode) {
        for (unsigned command = 0; command < 256; ++command) {
            const auto next = after(static_cast<AxisMode>(mode), static_cast<AxisCommand>(command));
            ASSERT_TRUE(!next || (mode < modes && static_cast<std::size_t>(*next) < modes));
        }
        EXPECT_EQ(to_text(static_cast<AxisMode>(mode)) == "?", mode >= modes);
    }
}

} // namespace
} // namespace tappet::motion
