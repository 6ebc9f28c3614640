// Whatever one sample says, what keeps a state lets no value out that is no number, and is what it would have
// been some samples later.
#include "kernel/motion/estimators.hpp"
#include "kernel/motion/filters.hpp"
#include "kernel/motion/pid.hpp"
#include "kernel/pieces/integrator.hpp"
#include "kernel/pieces/lead.hpp"
#include "tests/kernel/base/seeded.hpp"

namespace tappet::motion {
namespace {

using test::no_number, test::infinite;
constexpr double largest = std::numeric_limits<double>::max();
constexpr Duration step = 1ms, constant = 10ms;
constexpr int settles = 8000; // 800 time constants: of any double nothing is left

class OneSample : public testing::TestWithParam<double> {};

TEST_P(OneSample, is_forgotten_by_a_low_pass) {
    LowPass filter{constant};
    EXPECT_EQ(filter(1.0, step), 1.0);
    EXPECT_TRUE(is_number(filter(GetParam(), step)));
    for (int n = 0; n < settles; ++n) ASSERT_TRUE(is_number(filter(1.0, step))) << n;
    EXPECT_NEAR(filter(1.0, step), 1.0, 1e-9);
}

TEST_P(OneSample, is_forgotten_by_lead_and_lag) {
    for (const Duration lead : {2ms, 50ms}) {
        LeadLag filter{lead, constant};
        EXPECT_NEAR(filter(1.0, step), 1.0, 1e-12);
        EXPECT_TRUE(is_number(filter(GetParam(), step)));
        for (int n = 0; n < settles; ++n) ASSERT_TRUE(is_number(filter(1.0, step))) << n;
        EXPECT_NEAR(filter(1.0, step), 1.0, 1e-9);
    }
}

TEST_P(OneSample, is_forgotten_by_filters_of_second_order) {
    for (Biquad filter : {*Biquad::low_pass(20.0, step), *Biquad::notch(50.0, 20.0, step)}) {
        EXPECT_NEAR(filter(1.0), 1.0, 1e-12);
        EXPECT_TRUE(is_number(filter(GetParam())));
        Biquad untouched = filter;
        untouched.reset();
        for (int n = 0; n < 4 * settles; ++n) ASSERT_TRUE(is_number(filter(1.0))) << n;
        EXPECT_NEAR(filter(1.0), 1.0, 1e-9);
        EXPECT_NEAR(untouched(1.0), 1.0, 1e-9);
        for (int n = 0; n < 20; ++n) EXPECT_NEAR(filter(2.0), untouched(2.0), 1e-9) << "it filters";
    }
}

TEST_P(OneSample, is_forgotten_by_an_estimator) {
    AlphaBeta estimator{AlphaBetaGains::critically_damped(0.8)};
    Time at{};
    const auto sample = [&](double value) { estimator.sample(value, at += step); };
    for (int n = 0; n < 10; ++n) sample(1.0);
    sample(GetParam());
    for (int n = 0; n < settles; ++n) {
        sample(1.0);
        ASSERT_TRUE(is_number(estimator.at(at)) && is_number(estimator.velocity())) << n;
    }
    EXPECT_NEAR(estimator.at(at), 1.0, 1e-6);
    EXPECT_NEAR(estimator.velocity(), 0.0, 1e-6);
}

TEST_P(OneSample, is_forgotten_by_dead_time_compensation_after_two_samples) {
    Lead lead{100ms};
    Time at{};
    for (const double value : {1.0, 1.0, GetParam()}) lead.sample(value, at += step);
    EXPECT_TRUE(!lead.good(at) || is_number(lead.at(at)));
    for (int n = 0; n < 2; ++n) lead.sample(1.0, at += step);
    EXPECT_TRUE(lead.good(at));
    EXPECT_EQ(lead.at(at + 5ms), 1.0);
}

TEST_P(OneSample, leaves_an_integral_between_its_limits) {
    Integrator litres{0.0, 100.0};
    Time at{};
    for (const double value : {1.0, 1.0, GetParam(), 1.0, 1.0}) {
        const double sum = litres(value, at += step);
        EXPECT_TRUE(sum >= 0.0 && sum <= 100.0) << sum;
    }
    Integrator endless;
    for (const double value : {1.0, largest, largest, GetParam(), -largest, -largest, 1.0})
        EXPECT_TRUE(is_number(endless(value, at += 1h)));
}

/// The heater of a plant of first order, which is at its set point again after some time constants.
TEST_P(OneSample, moves_a_controller_by_its_span_at_most) {
    for (const double tracking_s : {0.0, 0.05, 1.0})
        for (const double derivative : {0.0, 0.01})
            for (const bool of_set_point : {false, true}) {
                Pid pid{{.proportional = 2.0,
                         .integral = 5.0,
                         .derivative = derivative,
                         .derivative_filter_s = 0.02,
                         .tracking_s = tracking_s,
                         .lowest = 0.0,
                         .highest = 10.0}};
                double is = 0.0;
                const auto run = [&](double set_point, double measured) {
                    const double put_out = pid(set_point, measured, step);
                    EXPECT_TRUE(put_out >= 0.0 && put_out <= 10.0) << put_out;
                    is += (put_out - is) * 0.001 / 0.2;
                };
                for (int n = 0; n < 20'000; ++n) run(4.0, is);
                EXPECT_NEAR(is, 4.0, 1e-3);
                of_set_point ? run(GetParam(), is) : run(4.0, GetParam());
                for (int n = 0; n < 20'000; ++n) run(4.0, is);
                EXPECT_NEAR(is, 4.0, 1e-3) << "tracking " << tracking_s << ", derivative " << derivative;
            }
}

TEST_P(OneSample, does_not_stay_in_a_controller_without_limits) {
    Pid pid{{.proportional = 2.0, .integral = 5.0, .derivative = 0.1}};
    for (const double measured : {1.0, GetParam(), 1.0, 1.0})
        EXPECT_TRUE(is_number(pid(1.0, measured, step)));
    for (const double measured : {largest, -largest, largest, 1.0})
        EXPECT_TRUE(is_number(pid(1.0, measured, step)));
    pid.track(1.0, 1.0, 3.0);
    EXPECT_NEAR(pid(1.0, 1.0, step), 3.0, 1e-9) << "somebody's hand begins it anew";
}

INSTANTIATE_TEST_SUITE_P(thatIs, OneSample,
                         testing::Values(no_number, infinite, -infinite, largest, -largest, 1e306, -1e306,
                                         3.4e38, -3.4e38, 1e-310, 0.0));

} // namespace
} // namespace tappet::motion
