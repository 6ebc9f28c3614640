// Angles are exact, wrap automatically and give the shortest way.
#include "kernel/cam/angle.hpp"

#include "tests/kernel/base/seeded.hpp"

#include <cmath>
#include <limits>

namespace tappet {
namespace {

TEST(Angle, wraps_within_one_turn) {
    static_assert(Angle{370_deg} == Angle{10_deg});
    static_assert(Angle{-10_deg} == Angle{350_deg});
    static_assert(Angle{360_deg} == Angle{});
    static_assert((Angle{350_deg} + 20_deg) == Angle{10_deg});
    EXPECT_NEAR(Angle::degrees(-0.5).in_degrees(), 359.5, 1e-7);
}

TEST(Angle, has_a_signed_difference_along_the_shortest_way) {
    static_assert(Angle{10_deg} - Angle{350_deg} == 20_deg);
    static_assert(Angle{350_deg} - Angle{10_deg} == -(20_deg));
    static_assert(Angle{180_deg} - Angle{0_deg} == -(180_deg));
    static_assert(forward_way(350_deg, 10_deg) == 20_deg);
    static_assert(forward_way(10_deg, 350_deg) == 340_deg);
}

using AnyAngle = test::Seeded;

TEST_F(AnyAngle, survives_conversion_to_degrees_and_back_within_one_unit) {
    for (int i = 0; i < 100'000; ++i) {
        const double degrees = random.unit() * 360.0;
        EXPECT_NEAR(Angle::degrees(degrees).in_degrees(), degrees, 360.0 / 0x1p32);
    }
}

TEST(Angle, represents_eighth_turns_exactly) {
    for (int i = 0; i < 8; ++i) EXPECT_EQ(Angle::degrees(45.0 * i).in_degrees(), 45.0 * i);
}

TEST(ShaftPosition, keeps_its_precision_after_a_thousand_million_turns) {
    const ShaftPosition far{1'000'000'000, 90_deg};
    EXPECT_EQ(far.turns(), 1'000'000'000);
    EXPECT_EQ(far.angle(), Angle{90_deg});
    EXPECT_EQ(((far + Rotation::units(1)) - far).in_units(), 1);
}

TEST(ShaftPosition, has_differences_unaffected_by_counter_wrap) {
    const ShaftPosition last{(std::int64_t{1} << 31) - 1, 270_deg};
    const ShaftPosition next = last + 180_deg;
    EXPECT_EQ(next - last, 180_deg);
    EXPECT_EQ(last - next, -(180_deg));
    EXPECT_EQ(next.angle(), Angle{90_deg});
}

TEST(ShaftPosition, counts_negative_turns_downwards) {
    const ShaftPosition behind = ShaftPosition{} - 10_deg;
    EXPECT_EQ(behind.turns(), -1);
    EXPECT_EQ(behind.angle(), Angle{350_deg});
    EXPECT_NEAR(behind.in_degrees(), -10.0, 1e-7);
}

TEST(Rotation, clamps_values_beyond_any_real_shaft) {
    const double infinity = std::numeric_limits<double>::infinity();
    const Rotation most = Rotation::turns(std::int64_t{1} << 30);
    EXPECT_EQ(Rotation::degrees(infinity), most);
    EXPECT_EQ(Rotation::degrees(1e300), most);
    EXPECT_EQ(Rotation::degrees(-infinity), -most);
    EXPECT_EQ(Rotation::degrees(std::nan("")), -most);
}

TEST(Speed, has_consistent_turns_per_minute_and_degrees_per_second) {
    static_assert((600_rpm).in_deg_s() == 3600.0);
    EXPECT_EQ(Speed::deg_s(-6.0).in_rpm(), -1.0);
}

} // namespace
} // namespace tappet
