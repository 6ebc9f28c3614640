// The estimator against a simulated true shaft: its accuracy, and its response to bad samples.

#include "tests/kernel/base/seeded.hpp"
#include "tests/kernel/cam/true_shaft.hpp"

namespace tappet::test {
namespace {

using AnEstimator = Seeded;

// Follows the shaft and collects the angle error between samples (up to 0.9 ms after one) from `from_s` on.
void follow(const TrueShaft& shaft, const Sampling& sampling, double from_s, Random& random, Errors& errors) {
    ShaftEstimator estimator{properties_for(sampling)};
    const double offset = random.unit() * 360.0;
    double t = 0.0;
    while (true) {
        const double noise = random.unit() - 0.5;
        t += sampling.period_s + noise * sampling.period_jitter_s;
        if (t + 1e-3 > shaft.end_s()) break;
        const double delay = random.unit() * sampling.stamp_delay_s;
        if (random.one_in(sampling.missing_one_in)) continue;
        estimator.sample(code_at(shaft.degrees(t) + offset, sampling.codes_per_turn), at_s(t + delay));
        if (t < from_s) continue;
        const double ahead = t + (0.1 + 0.8 * random.unit()) * sampling.period_s;
        const double seen = estimator.at(at_s(ahead)).position.angle().in_degrees();
        errors.add(apart(seen, shaft.degrees(ahead) + offset));
    }
    EXPECT_EQ(estimator.counters().implausible, 0u);
    EXPECT_EQ(estimator.counters().resets, 0u);
}

struct Case {
    std::string name;
    TrueShaft shaft;
    double from_s;
    double most_speed_deg_s;
    bool braking;
};

std::vector<Case> cases() {
    std::vector<Case> all;
    for (const int rpm : {60, 300, 600, 1350, 2000}) {
        all.push_back(
            {std::to_string(rpm) + " rpm", TrueShaft(0.0).jump(rpm * 6.0).hold(3.0), 0.2, rpm * 6.0, false});
        if (rpm == 600)
            all.push_back({"-600 rpm", TrueShaft(0.0).jump(-3600.0).hold(3.0), 0.2, 3600.0, false});
    }
    all.push_back(
        {"0 to 600 rpm in 0.5 s", TrueShaft(0.0).hold(0.1).ramp(3600.0, 0.5).hold(0.2), 0.05, 3600.0, true});
    all.push_back({"600 rpm to 0 in 60 deg", TrueShaft(0.0).jump(3600.0).hold(0.3).brake(60.0).hold(0.1),
                   0.29, 3600.0, true});
    all.push_back({"600 rpm to 0 in 100 deg", TrueShaft(0.0).jump(3600.0).hold(0.3).brake(100.0).hold(0.1),
                   0.29, 3600.0, true});
    return all;
}

TEST_F(AnEstimator, is_near_the_true_angle_between_samples) {
    for (const double delay_s : {0.0, 100e-6}) {
        for (const std::uint32_t codes : {4096u, 180u}) {
            for (const Case& one : cases()) {
                Errors errors;

                const Sampling sampling{
                    .codes_per_turn = codes, .stamp_delay_s = delay_s, .missing_one_in = 20};
                for (int run = 0; run < 10; ++run) follow(one.shaft, sampling, one.from_s, random, errors);
                const std::string what = one.name + ", " + std::to_string(codes) + " codes" +
                                         (delay_s > 0.0 ? ", stamps late up to 100 us" : "");
                errors.print(what.c_str());
                const double step = 360.0 / codes;
                const double late = one.most_speed_deg_s * delay_s * 0.29; // sigma of the stamps
                EXPECT_LT(errors.p50(), (one.braking ? 0.65 : 0.3) * step + late) << what;
                EXPECT_LT(errors.p99(), (one.braking ? 2.0 : 0.7) * step + 3.5 * late) << what;
                EXPECT_LT(errors.max(),
                          (one.braking ? 2.5 : 1.2) * step + 6.0 * late + (one.braking ? 0.6 : 0.1))
                    << what;
            }
        }
    }
}

// A shaft at constant speed and an estimator that has settled on it.
struct Settled {
    explicit Settled(double deg_s, const ShaftProperties& properties = {})
        : speed(deg_s), codes(properties.codes_per_turn), estimator(properties) {
        run(0.3);
    }
    void step() {
        t += 1e-3;
        estimator.sample(code(), at_s(t));
    }
    void run(double for_s) {
        for (const double until = t + for_s; t < until;) step();
    }
    [[nodiscard]] std::uint32_t code() const { return code_at(speed * t + 10.0, codes); }
    [[nodiscard]] double error() const {
        return apart(estimator.at(at_s(t)).position.angle().in_degrees(), speed * t + 10.0);
    }
    double speed;
    std::uint32_t codes;
    double t = 0.0;
    ShaftEstimator estimator;
};

TEST(ShaftEstimator, counts_turns_in_both_directions_across_the_wrap) {
    for (const double speed : {3600.0, -3600.0}) {
        Settled s(speed);
        const ShaftPosition from = s.estimator.at(at_s(s.t)).position;
        s.run(10.0);
        EXPECT_NEAR((s.estimator.at(at_s(s.t)).position - from).in_degrees(), speed * 10.0,
                    0.2 + std::fabs(speed) * 2e-3);
        EXPECT_NEAR(s.estimator.at(at_s(s.t)).velocity_deg_s, speed, 30.0);
    }
}

TEST(ShaftEstimator, reports_exactly_zero_speed_at_standstill_without_drift) {
    for (const std::uint32_t codes : {4096u, 180u}) {
        ShaftEstimator estimator({.codes_per_turn = codes});
        const TrueShaft shaft = TrueShaft(0.0).jump(3600.0).hold(0.3).brake(80.0).hold(20.0);
        const double stop = 0.3 + 160.0 / 3600.0;
        double t = 0.0;
        ShaftPosition stood;
        for (; t < shaft.end_s(); t += 1e-3) {
            estimator.sample(code_at(shaft.degrees(t), codes), at_s(t));
            if (t < stop + 0.06) { // a slow last step, and standstill_after
                stood = estimator.at(at_s(t)).position;
                continue;
            }
            ASSERT_EQ(estimator.at(at_s(t)).velocity_deg_s, 0.0);
            ASSERT_EQ(estimator.at(at_s(t)).position, stood);
        }
        EXPECT_TRUE(estimator.standing());
        EXPECT_LE(std::fabs(apart(stood.angle().in_degrees(), shaft.degrees(t))), 360.0 / codes);
    }
}

TEST_F(AnEstimator, is_at_standstill_when_the_shaft_rests_between_two_codes) {
    Settled s(0.0);

    const std::uint32_t code = s.code();
    const ShaftPosition stood = s.estimator.at(at_s(s.t)).position;
    bool left = false;
    for (int i = 0; i < 5000; ++i) {
        s.t += 1e-3;
        s.estimator.sample(random.one_in(2) ? code : code + 1, at_s(s.t));
        if (i < 100) continue;
        left = left || !s.estimator.standing();
    }
    EXPECT_FALSE(left);
    EXPECT_LT(std::fabs((s.estimator.at(at_s(s.t)).position - stood).in_degrees()), 0.2);
}

TEST(ShaftEstimator, rejects_and_counts_duplicates_old_stamps_and_impossible_codes) {
    Settled s(3600.0);
    const ShaftState before = s.estimator.at(at_s(s.t));
    s.estimator.sample(s.code(), at_s(s.t));
    s.estimator.sample(s.code(), at_s(s.t - 0.5e-3));
    s.estimator.sample(0, Time::min());
    s.estimator.sample(4096, at_s(s.t + 1e-3));
    s.estimator.sample(0xffff'ffff, at_s(s.t + 1e-3));
    EXPECT_EQ(s.estimator.counters().out_of_order, 3u);
    EXPECT_EQ(s.estimator.counters().bad_code, 2u);
    EXPECT_EQ(s.estimator.at(at_s(s.t)).position, before.position);
    EXPECT_FALSE(s.estimator.fault());
}

TEST(ShaftEstimator, raises_a_fault_on_an_impossible_jump_and_keeps_its_position) {
    Settled s(3600.0);
    s.t += 1e-3;
    s.estimator.sample((s.code() + 2048) % 4096, at_s(s.t));
    EXPECT_TRUE(s.estimator.fault());
    EXPECT_EQ(s.estimator.counters().implausible, 1u);
    s.run(0.01);
    EXPECT_LT(std::fabs(s.error()), 0.3);
    EXPECT_EQ(s.estimator.epoch(), 0u);
    EXPECT_TRUE(s.estimator.fault()) << "it stays until acknowledged";
    s.estimator.acknowledge();
    EXPECT_FALSE(s.estimator.fault());
}

TEST(ShaftEstimator, accepts_a_jump_after_three_consistent_samples) {
    Settled s(3600.0);
    const auto jumped = [&] {
        s.t += 1e-3;
        s.estimator.sample((s.code() + 1500) % 4096, at_s(s.t));
    };
    jumped();
    jumped();
    EXPECT_EQ(s.estimator.epoch(), 0u);
    jumped();
    EXPECT_EQ(s.estimator.epoch(), 1u);
    EXPECT_FALSE(s.estimator.valid(at_s(s.t))) << "a new beginning has to settle";
    for (int i = 0; i < 50; ++i) jumped();
    EXPECT_TRUE(s.estimator.valid(at_s(s.t)));
    EXPECT_NEAR(apart(s.estimator.at(at_s(s.t)).position.angle().in_degrees(), s.speed * s.t + 10.0),
                1500 * 360.0 / 4096, 0.3);
}

TEST(ShaftEstimator, rejects_jumps_that_disagree) {
    Settled s(0.0);
    const std::uint32_t code = s.code();
    for (int i = 0; i < 6; ++i) {
        s.t += 1e-3;
        s.estimator.sample((code + 1000 + 1000 * static_cast<std::uint32_t>(i % 2)) % 4096, at_s(s.t));
    }
    EXPECT_EQ(s.estimator.epoch(), 0u);
    EXPECT_EQ(s.estimator.counters().implausible, 6u);
    EXPECT_LT(std::fabs(s.error()), 0.1);
}

TEST(ShaftEstimator, ignores_a_single_outlier) {
    Settled s(3600.0);
    const std::uint32_t stale = s.code();
    s.t += 1e-3;
    s.estimator.sample(stale, at_s(s.t)); // an old frame with a new stamp
    EXPECT_EQ(s.estimator.counters().outliers, 1u);
    EXPECT_LT(std::fabs(s.error()), 0.3);
    s.run(0.01);
    EXPECT_LT(std::fabs(s.error()), 0.2);
    EXPECT_FALSE(s.estimator.fault());
}

TEST(ShaftEstimator, follows_a_crash_stronger_than_any_braking) {
    Settled s(3600.0);
    const double stopped_at = s.speed * s.t + 10.0;
    s.speed = 0.0;
    for (int i = 0; i < 60; ++i) {
        s.t += 1e-3;
        s.estimator.sample(code_at(stopped_at, 4096), at_s(s.t));
    }
    EXPECT_TRUE(s.estimator.standing());
    EXPECT_LT(std::fabs(apart(s.estimator.at(at_s(s.t)).position.angle().in_degrees(), stopped_at)), 0.1);
}

TEST(ShaftEstimator, becomes_stale_and_restarts_after_a_long_gap) {
    Settled s(3600.0);
    EXPECT_TRUE(s.estimator.valid(at_s(s.t + 4e-3)));
    EXPECT_FALSE(s.estimator.valid(at_s(s.t + 4.1e-3)));
    s.t += 0.5;
    s.step();
    EXPECT_EQ(s.estimator.counters().gaps, 1u);
    EXPECT_EQ(s.estimator.epoch(), 1u);
    EXPECT_FALSE(s.estimator.valid(at_s(s.t)));
    s.run(0.05);
    EXPECT_TRUE(s.estimator.valid(at_s(s.t)));
    EXPECT_LT(std::fabs(s.error()), 0.2);
}

TEST(ShaftEstimator, keeps_its_position_over_a_gap_only_at_standstill) {
    Settled s(0.0);
    s.t += 10.0;
    s.step();
    EXPECT_EQ(s.estimator.epoch(), 0u);
    EXPECT_TRUE(s.estimator.valid(at_s(s.t)));
    s.t += 10.0;
    s.estimator.sample(s.code() + 300, at_s(s.t));
    EXPECT_EQ(s.estimator.epoch(), 1u);
}

TEST(ShaftEstimator, predicts_the_time_of_a_crossing) {
    for (const double speed : {3600.0, -3600.0}) {
        Settled s(speed);
        const ShaftState here = s.estimator.at(at_s(s.t));
        const ShaftPosition target = here.position + Rotation::degrees(speed * 5e-3);
        EXPECT_NEAR(to_seconds(s.estimator.when(target, at_s(s.t)) - at_s(s.t)), 5e-3, 0.1e-3);
        EXPECT_EQ(s.estimator.when(here.position - Rotation::degrees(speed * 1e-3), at_s(s.t)), never);
    }
    Settled standing(0.0);
    EXPECT_EQ(standing.estimator.when(ShaftPosition{1, {}}, at_s(standing.t)), never);
}

TEST_F(AnEstimator, survives_any_bytes) {

    ShaftEstimator estimator{ShaftProperties{}};
    std::int64_t t = 0;
    for (int i = 0; i < 200'000; ++i) {
        t += random.one_in(100) ? random.between(-10'000'000, 100'000'000) : random.between(-100, 2'000'000);
        const std::uint64_t code = random.below(4200);
        estimator.sample(static_cast<std::uint32_t>(code), at_ns(t));
        const ShaftState state = estimator.at(at_ns(t));
        ASSERT_TRUE(std::isfinite(state.velocity_deg_s) && std::isfinite(estimator.deviation_deg()));
        ASSERT_LE(std::fabs(state.velocity_deg_s), (2200_rpm).in_deg_s() * 3.0);
    }
    const double true_speed = 1200.0; // and follows again when samples are valid
    for (int i = 0; i < 200; ++i) {
        t += 1'000'000;
        estimator.sample(code_at(true_speed * static_cast<double>(t) * 1e-9, 4096), at_ns(t));
    }
    const double truth = true_speed * static_cast<double>(t) * 1e-9;
    EXPECT_TRUE(estimator.valid(at_ns(t)));
    EXPECT_LT(std::fabs(apart(estimator.at(at_ns(t)).position.angle().in_degrees(), truth)), 0.2);
}

TEST(ShaftProperties, are_checked_with_a_message) {
    static_assert(check(ShaftProperties{}).empty());
    EXPECT_EQ(check({.codes_per_turn = 4}).view(),
              "shaft: codes_per_turn is 4; give a number from 8 to 16777216");
    EXPECT_FALSE(check({.max_speed = Speed{}}).empty());
    EXPECT_FALSE(check({.max_acceleration_deg_s2 = 0.0}).empty());
    EXPECT_FALSE(check({.jerk_density = 0.0}).empty());
    EXPECT_FALSE(check({.stamp_jitter = -1us}).empty());
    EXPECT_FALSE(check({.lost_after = 1ms}).empty());
    EXPECT_EQ(check({.lost_after = 100ms}).view(),
              "shaft: in a gap of lost_after the shaft may turn half a turn unseen at "
              "max_acceleration_deg_s2; shorten lost_after");
}

} // namespace
} // namespace tappet::test
