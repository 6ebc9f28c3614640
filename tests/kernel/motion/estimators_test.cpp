// Estimators against expected results: least squares over all measurements, and each other at steady state.
#include "kernel/motion/estimators.hpp"
#include "tests/kernel/base/seeded.hpp"
#include "tests/kernel/motion/random_motion.hpp"

#include <Eigen/Cholesky>

#include <cmath>

namespace tappet::motion::test {
namespace {

using namespace tappet::test;
using KalmanFilter = Seeded;
using SolvePositive = Seeded;

TEST(AlphaBeta, follows_and_predicts_a_ramp_without_error) {
    for (const double memory : {0.0, 0.3, 0.8}) {
        AlphaBeta estimator{AlphaBetaGains::critically_damped(memory)};
        EXPECT_FALSE(estimator.good());
        for (int k = 0; k < 500; ++k) estimator.sample(2.0 + 3.0 * k * 1e-2, Time{k * 10ms});
        EXPECT_TRUE(estimator.good());
        EXPECT_NEAR(estimator.velocity(), 3.0, 1e-9);
        EXPECT_NEAR(estimator.at(at_ns(6'000'000'000)), 20.0, 1e-8);
    }
}

TEST(AlphaBeta, decays_a_jump_by_the_square_of_its_memory) {
    // Both poles at m: the error of the n-th sample after a jump falls like n m^n.
    AlphaBeta estimator{AlphaBetaGains::critically_damped(0.5)};
    for (int k = 0; k < 100; ++k) estimator.sample(0.0, Time{k * 1ms});
    double error = 0.0;
    for (int k = 100; k < 140; ++k) {
        estimator.sample(1.0, Time{k * 1ms});
        error = 1.0 - estimator.at(Time{k * 1ms});
    }
    EXPECT_NEAR(error, 0.0, 50.0 * std::pow(0.5, 40.0));
}

TEST(AlphaBeta, ignores_and_reports_invalid_or_old_samples) {
    AlphaBeta estimator{{0.5, 0.1}};
    estimator.sample(1.0, at_ns(1000));
    estimator.sample(no_number, at_ns(2000));
    estimator.sample(2.0, at_ns(1000));
    EXPECT_EQ(estimator.refused(), 2u);
    EXPECT_EQ(estimator.at(at_ns(5000)), 1.0);
    estimator.reset();
    estimator.sample(4.0, at_ns(10));
    EXPECT_EQ(estimator.at(at_ns(20)), 4.0);
}

TEST(AlphaBeta, restarts_after_an_impossible_time) {
    AlphaBeta estimator{AlphaBetaGains::critically_damped(0.5)};
    Time now{10s};
    for (int i = 0; i < 100; ++i) estimator.sample(0.01 * i, now += 10ms);
    estimator.sample(1.0, now + 1h);
    for (int i = 100; i < 150; ++i) estimator.sample(0.01 * i, now += 10ms);
    EXPECT_TRUE(estimator.good());
    EXPECT_NEAR(estimator.at(now), 1.49, 1e-6);
    EXPECT_EQ(estimator.refused(), static_cast<std::uint32_t>(AlphaBeta::most_before));
}

TEST(AlphaBeta, refuses_unstable_gains) {
    EXPECT_EQ(check(AlphaBetaGains{.5, .17}), "");
    for (const AlphaBetaGains bad : {AlphaBetaGains{0.0, 0.1}, {0.5, 0.0}, {1.0, 2.0}, {no_number, 1.0}}) {
        EXPECT_EQ(check(bad),
                  "these gains are not stable; set alpha and beta positive and 2 alpha + beta below 4");
        EXPECT_DEATH(AlphaBeta{bad}, "contract 5 refused-settings");
    }
}

TEST(Kalman, converges_to_the_gains_of_the_tracking_index) {
    const double h = 0.01;
    const double measured = 0.3;
    const double pushed = 50.0;
    Eigen::Matrix2d f{{1.0, h}, {0.0, 1.0}};
    const Eigen::Vector2d push{0.5 * h * h, h};
    const Eigen::Matrix2d q = push * push.transpose() * pushed * pushed;
    const Eigen::RowVector2d row{1.0, 0.0};
    const Eigen::Matrix<double, 1, 1> r{measured * measured};
    Kalman<2> filter{Eigen::Vector2d::Zero(), Eigen::Matrix2d::Identity() * 100.0};
    for (int k = 0; k < 5000; ++k) {
        filter.predict(f, q);
        ASSERT_TRUE(filter.update<1>(Eigen::Matrix<double, 1, 1>{0.0}, row, r));
    }
    filter.predict(f, q);
    const auto& spread = filter.covariance();
    const double total = spread(0, 0) + measured * measured;
    const auto gains = AlphaBetaGains::for_tracking_index(pushed * h * h / measured);
    EXPECT_NEAR(spread(0, 0) / total, gains.alpha, 1e-9);
    EXPECT_NEAR(spread(1, 0) / total * h, gains.beta, 1e-9);
}

TEST_F(KalmanFilter, equals_least_squares_without_process_noise) {
    const Eigen::Matrix3d prior = Eigen::Vector3d{1.0, 4.0, 9.0}.asDiagonal();
    Kalman<3> filter{Eigen::Vector3d::Zero(), prior};
    Eigen::Matrix3d information = prior.inverse();
    Eigen::Vector3d weighted = Eigen::Vector3d::Zero();
    for (int k = 0; k < 50; ++k) {
        Eigen::Matrix<double, 2, 3> h;
        for (int i = 0; i < 6; ++i) h(i) = within(random, 1.0);
        const Eigen::Vector2d z{within(random, 1.0), within(random, 1.0)};
        const double correlation = within(random, 0.1);
        const Eigen::Matrix2d r{{0.5, correlation}, {correlation, 0.2}};
        ASSERT_TRUE(filter.update<2>(z, h, r));
        information += h.transpose() * r.inverse() * h;
        weighted += h.transpose() * r.inverse() * z;
    }
    EXPECT_NEAR((filter.state() - information.ldlt().solve(weighted)).norm(), 0.0, 1e-10);
    EXPECT_NEAR((filter.covariance() - information.inverse()).norm(), 0.0, 1e-10);
}

TEST(Kalman, rejects_outliers_and_invalid_values_and_keeps_its_state) {
    Kalman<2> filter{{1.0, 2.0}, Eigen::Matrix2d::Identity()};
    const Eigen::Matrix2d sees_both = Eigen::Matrix2d::Identity();
    const Eigen::Matrix2d noise = 3.0 * Eigen::Matrix2d::Identity();
    EXPECT_EQ(filter.update<2>({9.0, no_number}, sees_both, noise).error(),
              (Refused{Refusal::not_a_number, 1}));
    EXPECT_EQ(filter.update<2>({9.0, 2.0}, sees_both, noise, 9.0).error(), Refused{Refusal::outlier});
    EXPECT_EQ(filter.update<2>({9.0, 2.0}, sees_both, -noise).error(), Refused{Refusal::not_positive});
    EXPECT_EQ(filter.state(), (Eigen::Vector2d{1.0, 2.0}));
    const auto distance = filter.update<2>({5.0, 2.0}, sees_both, noise, 9.0);
    ASSERT_TRUE(distance);
    EXPECT_DOUBLE_EQ(*distance, 4.0) << "four away, with a deviation of two";
}

TEST_F(SolvePositive, solves_regular_systems_and_refuses_singular_ones) {
    for (int round = 0; round < 100; ++round) {
        Eigen::Matrix<double, 6, 6> factor;
        for (int i = 0; i < 36; ++i) factor(i) = within(random, 1.0);
        const Eigen::Matrix<double, 6, 6> a =
            factor * factor.transpose() + 0.1 * Eigen::Matrix<double, 6, 6>::Identity();
        Eigen::Matrix<double, 6, 2> x;
        for (int i = 0; i < 12; ++i) x(i) = within(random, 1.0);
        Eigen::Matrix<double, 6, 2> b = a * x;
        ASSERT_TRUE((solve_positive<6, 2>(a, b)));
        EXPECT_NEAR((b - x).norm(), 0.0, 1e-12);
    }
    Eigen::Vector2d b{1.0, 1.0};
    EXPECT_FALSE((solve_positive<2, 1>(Eigen::Matrix2d::Ones(), b)));
    EXPECT_FALSE((solve_positive<2, 1>(Eigen::Matrix2d::Constant(no_number), b)));
}

} // namespace
} // namespace tappet::motion::test
