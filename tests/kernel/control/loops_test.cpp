// Loops: the compiler's bound on gain times period times delay agrees with the closed form and with the axis;
// and the contact with a stiff surface behaves as computed.
#include "kernel/base/random.hpp"
#include "tests/kernel/control/axis.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

namespace tappet {
namespace {

using control_detail::is_stable;
using control_detail::most_stable;
using control_detail::most_without_overshoot;
using control_detail::SampledLoop;

static_assert(is_stable({0.9, 0.0, 1}) && !is_stable({1.1, 0.0, 1}), "the compiler answers");

TEST(Loops, have_the_closed_form_bounds) {
    for (std::size_t d = 0; d <= 12; ++d) {
        const double n = static_cast<double>(2 * d + 1);
        EXPECT_NEAR(most_stable(d), 2.0 * std::sin(std::numbers::pi / (2.0 * n)), 1e-9) << d;
        const double x = static_cast<double>(d);
        EXPECT_NEAR(most_without_overshoot(d), std::pow(x, x) / std::pow(x + 1.0, x + 1.0), 1e-12) << d;
    }
}

struct Run {
    double largest = 0.0; ///< largest position after a step to 1
    bool settles = false;
};

/// The loop, sample by sample.
Run simulate(const SampledLoop& loop) {
    std::array<double, 64> sent{};
    double x = 0.0, sum = 0.0;
    Run run;
    for (std::size_t k = 0; k < 40000; ++k) {
        const double error = 1.0 - x;
        sum += error;
        sent[k % 64] = loop.proportional * error + loop.integral * sum;
        if (k >= loop.dead_samples) x += sent[(k - loop.dead_samples) % 64];
        run.largest = std::max(run.largest, x);
        if (!(std::abs(x) < 1e6)) return run;
    }
    run.settles = std::abs(1.0 - x) < 1e-3;
    return run;
}

TEST(Loops, settle_exactly_when_the_stability_test_says_so) {
    for (std::size_t d = 0; d <= 6; ++d)
        for (const double share : {0.3, 0.6, 0.9, 0.98, 1.02, 1.2})
            for (const double integral_share : {0.0, 0.002, 0.02, 0.2}) {
                const double p = share * most_stable(d);
                const SampledLoop loop{p, integral_share * p * p, d};
                EXPECT_EQ(simulate(loop).settles, is_stable(loop))
                    << d << ' ' << share << ' ' << integral_share;
            }
}

TEST(Loops, overshoot_only_above_their_overshoot_bound) {
    for (std::size_t d = 1; d <= 6; ++d) {
        EXPECT_LE(simulate({0.999 * most_without_overshoot(d), 0.0, d}).largest, 1.0 + 1e-9) << d;
        EXPECT_GT(simulate({1.2 * most_without_overshoot(d), 0.0, d}).largest, 1.0 + 1e-6) << d;
    }
}

/// The loop with a delay that changes in each step, by a pattern or at random.
bool diverges(const SampledLoop& loop, Random& random) {
    std::array<double, 64> seen{};
    double x = 1.0, sum = 0.0;
    const std::size_t least = loop.dead_samples - loop.varying_samples;
    const std::uint64_t pattern = random.next(), length = 2 + random.below(40);
    const bool by_chance = random.one_in(2);
    for (std::size_t k = 0; k < 6000; ++k) {
        seen[k % 64] = x;
        const std::uint64_t way = by_chance ? random.next() : pattern >> k % length;
        const std::size_t late =
            least + (loop.varying_samples == 1 ? way % 2 : way % (loop.varying_samples + 1));
        const double error = -seen[(k + 64 - std::min(late, k)) % 64];
        sum += error;
        x += loop.proportional * error + loop.integral * sum;
        if (!(std::abs(x) < 1e9)) return true;
    }
    return false;
}

TEST(Loops, stay_stable_below_the_bound_with_varying_delay) {
    Random random{7};
    for (std::size_t d = 1; d <= 6; ++d)
        for (int i = 0; i < 200; ++i) {
            const SampledLoop loop{0.99 * control_detail::most_stable_at_any_delay(d), 0.0, d, d};
            EXPECT_TRUE(is_stable(loop));
            EXPECT_FALSE(diverges(loop, random)) << d;
        }
    EXPECT_TRUE(is_stable({0.60, 0.0, 2})) << "at a delay that stays";
    EXPECT_FALSE(is_stable({0.60, 0.0, 2, 1})) << "there is a pattern by which it grows";
}

TEST(Loops, never_diverge_when_accepted_and_mostly_diverge_when_refused) {
    Random random{11};
    int accepted = 0, refused = 0, refused_well = 0;
    for (int i = 0; i < 4000; ++i) {
        const std::size_t d = random.below(5), varying = d == 0 ? 0 : 1 + random.below(d);
        const double gain = random.unit();
        const SampledLoop loop{gain, gain * gain * random.unit() * 0.25, d, varying};
        bool grows = false;
        for (int k = 0; k < 8 && !grows; ++k) grows = diverges(loop, random);
        if (is_stable(loop)) {
            ++accepted;
            EXPECT_FALSE(grows) << loop.proportional << ' ' << loop.integral << ' ' << d << ' ' << varying;
        } else {
            ++refused;
            refused_well += grows ? 1 : 0;
        }
    }
    std::printf("%d accepted, %d refused, of which %d grew by a delay that was tried\n", accepted, refused,
                refused_well);
    EXPECT_GT(accepted, 500);
}

// ---- the contact: a force-controlled axis meets a surface of 1e5 N/m with a set point of 20 N; one sample
// is 2 ms, the delay two samples

constexpr double contact_stiffness = 1e5;
constexpr double wanted_force = 20.0;

/// The largest force in N from the free approach on, and whether it settles at the set point.
Run touch(double gain) {
    constexpr double period = 2e-3;
    std::array<double, 3> sent{};
    double x = -1e-3;
    Run run;
    for (std::size_t k = 0; k < 20000; ++k) {
        const double force = contact_stiffness * std::max(0.0, x);
        sent[k % 3] = gain * (wanted_force - force);
        if (k >= 2) x += period * sent[(k - 2) % 3];
        run.largest = std::max(run.largest, force);
    }
    run.settles = std::abs(contact_stiffness * x - wanted_force) < 1e-3 * wanted_force;
    return run;
}

TEST(Contact, behaves_as_computed_for_each_of_four_gains) {
    const double gentle = most_without_overshoot(2) / (contact_stiffness * 2e-3);
    EXPECT_NEAR(gentle, 7.4e-4, 0.01e-4);
    EXPECT_NEAR(gentle * wanted_force, 14.8e-3, 0.1e-3) << "m/s, on the approach";
    EXPECT_LT(touch(gentle).largest, 1.001 * wanted_force);
    EXPECT_TRUE(touch(gentle).settles);
    EXPECT_NEAR(touch(2 * gentle).largest, 1.24 * wanted_force, 0.02 * wanted_force);
    EXPECT_TRUE(touch(2 * gentle).settles);
    const double limit = most_stable(2) / (contact_stiffness * 2e-3);
    EXPECT_NEAR(touch(0.98 * limit).largest, 1.99 * wanted_force, 0.02 * wanted_force);
    EXPECT_TRUE(touch(0.98 * limit).settles);
    EXPECT_FALSE(touch(1.02 * limit).settles) << "it bounces for ever";
}

} // namespace
} // namespace tappet
