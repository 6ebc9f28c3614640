// Filters: their frequency responses, measured with sines, their start and their refusals.
#include "kernel/motion/filters.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace tappet::motion::test {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double period_s = 1e-3;
constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

/// The filter's response to e^(iwt) after the first ten seconds, over whole periods.
template <class Filter>
std::complex<double> response(Filter filter, double hz) {
    std::complex<double> sum = 0.0;
    const int whole = static_cast<int>(std::round(10.0 * hz)) > 0 ? 10000 : 0;
    for (int k = 0; k < 2 * whole; ++k) {
        const double angle = 2.0 * pi * hz * k * period_s;
        const double output = filter(std::cos(angle));
        if (k >= whole) sum += output * std::polar(1.0, -angle);
    }
    return sum * 2.0 / static_cast<double>(whole);
}

const auto with_steps = [](auto filter) {
    return [filter](double value) mutable { return filter(value, 1ms); };
};

/// The frequency to which Tustin's rule maps it, as s.
std::complex<double> tustin(double hz) { return {0.0, 2.0 / period_s * std::tan(pi * hz * period_s)}; }

TEST(LowPass, responds_to_a_sine_as_its_difference_equation_predicts) {
    for (const double hz : {1.0, 10.0, 100.0}) {
        const std::complex<double> back = std::polar(1.0, -2.0 * pi * hz * period_s);
        const auto expected = period_s / (0.02 * (1.0 - back) + period_s);
        EXPECT_NEAR(std::abs(response(with_steps(LowPass{20ms}), hz) - expected), 0.0, 1e-9) << hz;
    }
}

TEST(LowPass, starts_at_its_first_value_and_can_be_disabled) {
    LowPass filter{1s};
    EXPECT_EQ(filter(5.0, 1ms), 5.0);
    EXPECT_NEAR(filter(6.0, 1ms), 5.000999, 1e-6);
    EXPECT_NEAR(filter(no_number, 1ms), 5.000999, 1e-6);
    filter.reset();
    EXPECT_EQ(filter(-1.0, 1ms), -1.0);
    LowPass none{0s};
    EXPECT_EQ(none(1.0, 1ms), 1.0);
    EXPECT_EQ(none(2.0, 1ms), 2.0);
}

TEST(LeadLag, has_the_configured_lead_and_lag) {
    for (const double hz : {1.0, 5.0, 50.0}) {
        const auto s = tustin(hz);
        const auto expected = (1.0 + 0.05 * s) / (1.0 + 0.01 * s);
        EXPECT_NEAR(std::abs(response(with_steps(LeadLag{50ms, 10ms}), hz) - expected), 0.0, 1e-9) << hz;
        EXPECT_GT(std::arg(expected), 0.0);
    }
    LeadLag filter{10ms, 50ms};
    EXPECT_DOUBLE_EQ(filter(3.0, 1ms), 3.0);
    EXPECT_DOUBLE_EQ(filter(3.0, 1ms), 3.0);
    EXPECT_DOUBLE_EQ(filter(no_number, 1ms), 3.0);
    EXPECT_DEATH((LeadLag{10ms, 0s}), "contract 2 precondition: A function was called with 0");
}

TEST(Biquad, passes_low_frequencies) {
    const auto filter = Biquad::low_pass(40.0, 1ms);
    ASSERT_TRUE(filter);
    EXPECT_NEAR(std::abs(response(*filter, 40.0)), std::sqrt(0.5), 1e-9) << "3 dB at the corner";
    const double corner = std::abs(tustin(40.0));
    for (const double hz : {4.0, 20.0, 100.0, 400.0}) {
        const auto s = tustin(hz) / corner;
        EXPECT_NEAR(std::abs(response(*filter, hz) - 1.0 / (s * s + std::sqrt(2.0) * s + 1.0)), 0.0, 1e-9)
            << hz;
    }
}

TEST(Biquad, removes_one_frequency) {
    const auto filter = Biquad::notch(50.0, 5.0, 1ms);
    ASSERT_TRUE(filter);
    EXPECT_NEAR(std::abs(response(*filter, 50.0)), 0.0, 1e-9);
    EXPECT_NEAR(std::abs(response(*filter, 5.0)), 1.0, 1e-3);
    EXPECT_NEAR(std::abs(response(*filter, 47.6)), std::sqrt(0.5), 0.03);
    EXPECT_NEAR(std::abs(response(*filter, 52.6)), std::sqrt(0.5), 0.03);
}

TEST(Biquad, starts_at_rest_at_its_first_value) {
    for (auto filter : {*Biquad::low_pass(40.0, 1ms), *Biquad::notch(50.0, 5.0, 1ms)}) {
        for (int k = 0; k < 5; ++k) EXPECT_NEAR(filter(7.0), 7.0, 1e-12);
        EXPECT_NEAR(filter(no_number), 7.0, 1e-12);
        filter.reset();
        EXPECT_NEAR(filter(-1.0), -1.0, 1e-12);
    }
}

TEST(Biquad, is_refused_above_half_the_sampling_rate) {
    const Refused beyond{Refusal::beyond_half_rate};
    EXPECT_EQ(Biquad::low_pass(500.0, 1ms).error(), beyond);
    EXPECT_EQ(Biquad::low_pass(0.0, 1ms).error(), beyond);
    EXPECT_EQ(Biquad::low_pass(no_number, 1ms).error(), beyond);
    EXPECT_EQ(Biquad::notch(600.0, 5.0, 1ms).error(), beyond);
    EXPECT_EQ(Biquad::low_pass(40.0, 1ms, 0.0).error(), (Refused{Refusal::limit_not_positive, 2}));
    EXPECT_EQ(Biquad::notch(40.0, -1.0, 1ms).error(), (Refused{Refusal::limit_not_positive, 1}));
}

} // namespace
} // namespace tappet::motion::test
