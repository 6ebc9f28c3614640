// Sine and cosine against 80-bit results, and where they must be exact.
#include "kernel/motion/sine.hpp"
#include "tests/kernel/base/seeded.hpp"
#include "tests/kernel/motion/random_motion.hpp"

#include <cmath>

namespace tappet::motion::test {
namespace {

using namespace tappet::test;
using Sine = Seeded;

// Constant evaluation and run time use the same function.
static_assert(sine_cosine(0.0).sine == 0.0 && sine_cosine(0.0).cosine == 1.0);
static_assert(sine_cosine_of_degrees(90).cosine == 0.0 && sine_cosine_of_degrees(90).sine == 1.0);
static_assert(sine_cosine_of_degrees(-180).sine == 0.0 && sine_cosine_of_degrees(-180).cosine == -1.0);
static_assert(sine_cosine_of_degrees(270).sine == -1.0 && sine_cosine_of_degrees(-720).cosine == 1.0);

void expect_near_the_truth(double angle, SineCosine found) {
    EXPECT_NEAR(found.sine, static_cast<double>(std::sin(static_cast<long double>(angle))), 2.3e-16) << angle;
    EXPECT_NEAR(found.cosine, static_cast<double>(std::cos(static_cast<long double>(angle))), 2.3e-16)
        << angle;
}

TEST_F(Sine, is_exact_to_the_last_bit_over_many_turns) {
    for (const double most : {1e-9, 0.8, 3.2, 100.0, 1e5, 1e7})
        for (int i = 0; i < 20000; ++i) {
            const double angle = within(random, most);
            expect_near_the_truth(angle, sine_cosine(angle));
        }
    for (const double quarter :
         {1.5707963267948966, 3.1415926535897931, 4.7123889803846897, 0.78539816339744828}) {
        expect_near_the_truth(quarter, sine_cosine(quarter));
        expect_near_the_truth(-quarter, sine_cosine(-quarter));
    }
}

TEST_F(Sine, is_the_same_in_degrees) {
    for (int i = 0; i < 20000; ++i) {
        const double degrees = within(random, 400.0);
        const auto found = sine_cosine_of_degrees(degrees);
        const long double angle =
            static_cast<long double>(degrees) * (3.14159265358979323846264338328L / 180.0L);
        EXPECT_NEAR(found.sine, static_cast<double>(std::sin(angle)), 3e-16) << degrees;
        EXPECT_NEAR(found.cosine, static_cast<double>(std::cos(angle)), 3e-16) << degrees;
    }
}

TEST_F(Sine, is_the_same_for_two_angles_at_once) {
    for (int i = 0; i < 20000; ++i) {
        const double a = within(random, 1e5);
        const double b = within(random, 7.0);
        SineCosine of_a{};
        SineCosine of_b{};
        sine_cosine_of_two(a, b, of_a, of_b);
        EXPECT_EQ(of_a.sine, sine_cosine(a).sine);
        EXPECT_EQ(of_a.cosine, sine_cosine(a).cosine);
        EXPECT_EQ(of_b.sine, sine_cosine(b).sine);
        EXPECT_EQ(of_b.cosine, sine_cosine(b).cosine);
    }
}

TEST_F(Sine, is_not_a_number_when_its_angle_is_not) {
    for (const double bad : {no_number, infinite}) {
        EXPECT_TRUE(std::isnan(sine_cosine(bad).sine));
        EXPECT_TRUE(std::isnan(sine_cosine(bad).cosine));
    }
}

} // namespace
} // namespace tappet::motion::test
