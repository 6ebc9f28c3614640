// For any inputs in any order, stateful blocks return only numbers, respect their limits, and forget all
// inputs after a bounded number of samples.
#include "kernel/motion/estimators.hpp"
#include "kernel/motion/filters.hpp"
#include "kernel/motion/pid.hpp"
#include "tests/kernel/base/hostile.hpp"

namespace tappet::motion {
namespace {

constexpr int sequences = 40, long_one = 200, settles = 8000;
constexpr Duration usual = 1ms;

struct Sequences : test::Hostile {
    /// For filters that are called with a value and a step.
    template <class Filter>
    void expect_forgets(Filter filter, bool between) {
        double before = filter(number(), usual);
        for (int n = 0; n < long_one; ++n) {
            const double in = value();
            const Duration time = step();
            Filter at_once = filter;
            const double out = filter(in, time);
            if (time < 0ns) {
                ASSERT_EQ(out, at_once(in, 0ns)) << "time does not run backwards";
            }
            ASSERT_TRUE(is_number(out)) << n;
            const double slack = 1e-12 * std::max(std::fabs(in), std::fabs(before));
            if (between && is_number(in)) {
                ASSERT_TRUE(out >= std::min(in, before) - slack && out <= std::max(in, before) + slack)
                    << in << " after " << before << " gives " << out;
            }
            before = out;
        }
        for (int n = 0; n < settles; ++n) ASSERT_TRUE(is_number(filter(1.0, usual))) << n;
        EXPECT_NEAR(filter(1.0, usual), 1.0, 1e-9);
    }
};

TEST_F(Sequences, are_forgotten_by_a_low_pass_within_their_bounds) {
    for (int n = 0; n < sequences; ++n)
        for (const Duration constant : {Duration{10ms}, Duration{0}, Duration{-1s}})
            expect_forgets(LowPass{constant}, true);
}

TEST_F(Sequences, are_forgotten_by_lead_and_lag) {
    for (int n = 0; n < sequences; ++n)
        for (const Duration lead : {0ms, 2ms, 50ms}) expect_forgets(LeadLag{lead, 10ms}, false);
}

TEST_F(Sequences, are_forgotten_by_filters_of_second_order) {
    for (int n = 0; n < sequences; ++n)
        for (Biquad filter : {*Biquad::low_pass(20.0, usual), *Biquad::notch(50.0, 20.0, usual)}) {
            for (int k = 0; k < long_one; ++k) ASSERT_TRUE(is_number(filter(value()))) << k;
            for (int k = 0; k < 4 * settles; ++k) ASSERT_TRUE(is_number(filter(1.0))) << k;
            EXPECT_NEAR(filter(1.0), 1.0, 1e-9);
            Biquad untouched = filter;
            untouched.reset();
            EXPECT_NEAR(untouched(1.0), 1.0, 1e-9);
            for (int k = 0; k < 20; ++k) EXPECT_NEAR(filter(2.0), untouched(2.0), 1e-9) << "it filters";
        }
}

TEST_F(Sequences, of_settings_make_stable_second_order_filters_or_none) {
    int made = 0;
    for (int n = 0; n < 20'000; ++n) {
        const double hz = value(), second = value();
        const Duration period = random.one_in(2) ? usual : step();
        for (auto filter : {Biquad::low_pass(hz, period, second), Biquad::notch(hz, second, period)}) {
            if (!filter) continue;
            ++made;
            EXPECT_GT(hz, 0.0);
            for (int k = 0; k < 100; ++k) {
                const double out = (*filter)(k % 50 < 10 ? 0.0 : 1.0);
                ASSERT_LE(std::fabs(out), 1000.0)
                    << hz << " Hz, " << second << ", " << period.count() << " ns";
            }
        }
    }
    EXPECT_GT(made, 100);
    for (const double beyond : {std::numeric_limits<double>::max(), 1e308}) {
        EXPECT_FALSE(Biquad::low_pass(400.0, usual, beyond));
        EXPECT_FALSE(Biquad::notch(400.0, beyond, usual));
    }
}

TEST_F(Sequences, are_forgotten_by_an_estimator_of_a_value_and_its_speed) {
    for (int n = 0; n < sequences; ++n) {
        AlphaBeta estimator{AlphaBetaGains::critically_damped(0.8)};
        const auto expect_numbers = [&](Time at) {
            ASSERT_TRUE(is_number(estimator.velocity()));
            for (const Time when : {at, at + 1h, stamp(at), never, Time::min()})
                ASSERT_TRUE(is_number(estimator.at(when)));
        };
        Time at{};
        for (int k = 0; k < long_one; ++k) {
            estimator.sample(value(), at = stamp(at));
            expect_numbers(at);
        }
        at = Time{random.between(0, 1000) * 1s};
        for (int k = 0; k < settles; ++k) {
            estimator.sample(1.0, at += usual);
            ASSERT_NO_FATAL_FAILURE(expect_numbers(at)) << k;
        }
        EXPECT_NEAR(estimator.at(at), 1.0, 1e-6);
        EXPECT_NEAR(estimator.velocity(), 0.0, 1e-6);
    }
}

TEST_F(Sequences, of_gains_make_a_stable_estimator_or_are_refused) {
    int made = 0;
    for (int n = 0; n < 10'000; ++n) {
        const double first = value();
        const double second = value();
        for (const AlphaBetaGains gains :
             {AlphaBetaGains{first, second}, AlphaBetaGains::critically_damped(first),
              AlphaBetaGains::for_tracking_index(first)}) {
            if (!check(gains).empty()) continue;
            ++made;
            AlphaBeta estimator{gains};
            Time at{};
            for (int k = 0; k < 100; ++k) estimator.sample(k % 2 == 0 ? 1.0 : 0.0, at += usual);
            EXPECT_LE(std::fabs(estimator.at(at)), 1e9) << gains.alpha << " " << gains.beta;
        }
    }
    EXPECT_GT(made, 100);
}

// ---- the Kalman filter

using Two = Kalman<2>;
struct Moves {
    Two::Covariance f{{1.0, 1e-3}, {0.0, 1.0}}, q{{1e-9, 1e-6}, {1e-6, 1e-3}};
    Eigen::RowVector2d sees{1.0, 0.0};
    Eigen::Matrix<double, 1, 1> noise{1e-6};
};

void expect_numbers(const Two& filter) {
    for (int i = 0; i < 4; ++i) ASSERT_TRUE(is_number(filter.covariance()(i)));
    for (int i = 0; i < 2; ++i) ASSERT_TRUE(is_number(filter.state()[i]));
}

TEST_F(Sequences, are_forgotten_by_a_kalman_filter) {
    const Moves of{};
    for (int n = 0; n < sequences; ++n) {
        Two filter{Eigen::Vector2d::Zero(), Eigen::Matrix2d::Identity()};
        for (int k = 0; k < long_one; ++k) {
            const double u0 = value(), u1 = value();
            filter.predict(of.f, of.q, {u0, u1});
            ASSERT_NO_FATAL_FAILURE(expect_numbers(filter)) << k;
            const auto distance = filter.update<1>(Eigen::Matrix<double, 1, 1>{value()}, of.sees, of.noise);
            if (distance) {
                ASSERT_TRUE(is_number(*distance) && *distance >= 0.0) << *distance;
            }
            ASSERT_NO_FATAL_FAILURE(expect_numbers(filter)) << k;
        }
        for (int k = 0; k < settles; ++k) {
            filter.predict(of.f, of.q);
            static_cast<void>(filter.update<1>(Eigen::Matrix<double, 1, 1>{1.0}, of.sees, of.noise));
        }
        const Two before = filter;
        filter.predict(of.f, of.q, {test::no_number, 0.0});
        ASSERT_EQ(filter.state(), before.state()) << "what is no number is left out";
        EXPECT_NEAR(filter.state()[0], 1.0, 1e-6);
        EXPECT_NEAR(filter.state()[1], 0.0, 1e-6);
    }
}

TEST_F(Sequences, of_models_keep_a_kalman_filter_finite) {
    const auto matrix = [&] {
        Two::Covariance m;
        for (int i = 0; i < 4; ++i) m(i) = value();
        return m;
    };
    for (int n = 0; n < sequences; ++n) {
        Two filter{Eigen::Vector2d::Zero(), Eigen::Matrix2d::Identity()};
        for (int k = 0; k < long_one; ++k) {
            const Two::Covariance f = matrix(), q = matrix();
            filter.predict(f, q);
            ASSERT_NO_FATAL_FAILURE(expect_numbers(filter));
            const double z0 = value(), z1 = value();
            const Two::Covariance h = matrix(), r = matrix();
            const auto distance = filter.update<2>({z0, z1}, h, r, value());
            if (distance) {
                ASSERT_TRUE(is_number(*distance));
            }
            ASSERT_NO_FATAL_FAILURE(expect_numbers(filter));
        }
    }
}

// ---- the controller

struct Controllers : Sequences {
    /// With usable limits, and gains that are extreme, zero or those of a usual loop.
    PidGains gains() {
        const auto gain = [&](double most) {
            return random.one_in(3) ? number() : random.one_in(2) ? most : 0.0;
        };
        for (;;) {
            PidGains of;
            of.proportional = gain(2.0);
            of.integral = gain(5.0);
            of.derivative = gain(0.01);
            of.derivative_filter_s = std::fabs(gain(0.02));
            of.set_point_weight = gain(1.0);
            of.derivative_weight = gain(1.0);
            of.tracking_s = std::fabs(gain(0.05));
            of.dead_band = std::fabs(gain(0.1));
            of.lowest = value();
            of.highest = value();
            if (check(of).empty()) return of;
        }
    }
    /// Any call that a program can make.
    double any_call(Pid& pid, PidGains& of) {
        const double a = value(), b = value(), c = value(), d = random.one_in(2) ? 0.0 : value();
        switch (random.below(12)) {
        case 0: pid.track(a, b, c, d); return pid.output();
        case 1: pid.applied(a); return pid.output();
        case 2: pid.reset(); return pid.output();
        case 3: pid.tune(of = gains()); return pid.output();
        default: return pid(a, b, step(), d);
        }
    }
};

TEST_F(Controllers, output_numbers_within_their_limits_after_any_calls) {
    for (int n = 0; n < 20 * sequences; ++n) {
        PidGains of = gains();
        Pid pid{of};
        ASSERT_TRUE(pid.output() >= of.lowest && pid.output() <= of.highest);
        for (int k = 0; k < long_one; ++k) {
            const double out = any_call(pid, of);
            ASSERT_TRUE(is_number(out) && out >= of.lowest && out <= of.highest)
                << k << ": " << out << " of " << of.lowest << " .. " << of.highest;
            ASSERT_TRUE(is_number(pid.integral())) << k;
        }
    }
}

TEST_F(Controllers, without_limits_recover_by_manual_tracking) {
    for (int n = 0; n < sequences; ++n) {
        Pid pid{{.proportional = 2.0, .integral = 5.0, .derivative = 0.1}};
        for (int k = 0; k < long_one; ++k) ASSERT_TRUE(is_number(pid(1.0, value(), usual)));
        pid.track(1.0, 1.0, 3.0);
        EXPECT_NEAR(pid(1.0, 1.0, usual), 3.0, 1e-9);
    }
}

/// Afterwards the heater of a first-order plant returns to its set point.
TEST_F(Controllers, recover_after_any_sequence_of_measurements_and_set_points) {
    for (int n = 0; n < sequences / 4; ++n)
        for (const double tracking_s : {0.0, 0.05})
            for (const double derivative : {0.0, 0.01}) {
                Pid pid{{.proportional = 2.0,
                         .integral = 5.0,
                         .derivative = derivative,
                         .derivative_filter_s = 0.02,
                         .tracking_s = tracking_s,
                         .lowest = 0.0,
                         .highest = 10.0}};
                for (int k = 0; k < long_one; ++k) {
                    const double set_point = value(), measured = value(), before = pid.integral();
                    static_cast<void>(pid(set_point, measured, step()));
                    const bool begins_anew = pid.integral() == 0.0;
                    // One step leaves it between its old value and the limits, plus or minus their span.
                    const auto [low, high] = std::minmax({before, std::clamp(before, 0.0, 10.0)});
                    ASSERT_TRUE(begins_anew ||
                                (pid.integral() >= low - 10.0 - 1e-9 && pid.integral() <= high + 10.0 + 1e-9))
                        << before << " to " << pid.integral() << ": by more than the span of its limits";
                }
                double is = 0.0;
                for (int k = 0; k < 20'000; ++k) is += (pid(4.0, is, usual) - is) * 0.001 / 0.2;
                EXPECT_NEAR(is, 4.0, 1e-3) << "tracking " << tracking_s << ", derivative " << derivative;
            }
}

} // namespace
} // namespace tappet::motion
