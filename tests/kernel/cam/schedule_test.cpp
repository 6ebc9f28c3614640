// Rows fire once per crossing, on their angle, whatever the shaft does.
#include "tests/kernel/base/seeded.hpp"
#include "tests/kernel/cam/cam_rig.hpp"

#include <cstring>

namespace tappet::test {
namespace {

constexpr auto loom =
    cam_table(2200_rpm, cam("beat_up", at(0_deg)), cam("pick", at(80_deg), dead_time(2500us)),
              cam("arrival", window(200_deg, 260_deg), dead_time(300us)),
              cam("nozzle", window(300_deg, 60_deg), dead_time(2500us, 1800us), exclusive("nozzles")),
              cam("relay", window(60_deg, 180_deg), dead_time(2500us, 1800us), exclusive("nozzles")),
              cam("last", at(359.9_deg)));
static_assert(check(loom.view()).empty());

using Cams = Seeded;

// The true shaft angle at which the effect of a firing occurs, relative to the requested angle.
template <std::size_t N>
double effect_error(const CamRig<N>& rig, const CamTable<N>& table, const Fired& fired) {
    const CamRow& row = table.rows[fired.event.row];
    const Duration dead = fired.event.kind == CamKind::leave ? row.leave_dead_time : row.dead_time;
    return apart(rig.shaft.degrees(in_s(fired.at + dead)), fired.event.target.angle().in_degrees());
}

// Each row fired exactly once for each crossing between the first and the last. A window entered just before
// standstill is left at once, and again at its angle in the next turn.
template <std::size_t N> void expect_once_per_turn(const CamRig<N>& rig, const CamTable<N>& table, int step) {
    for (std::size_t row = 0; row < N; ++row) {
        for (const CamKind kind : {CamKind::point, CamKind::enter, CamKind::leave}) {
            const ShaftPosition* before = nullptr;
            for (const Fired& fired : rig.fired) {
                if (fired.event.row != row || fired.event.kind != kind || fired.event.forced) continue;
                if (before != nullptr) {
                    ASSERT_EQ(fired.event.target - *before, Rotation::turns(step)) << table.rows[row].name;
                }
                before = &fired.event.target;
            }
        }
    }
}

TEST_F(Cams, fires_every_row_exactly_once_per_turn_with_jitter_and_missing_samples) {
    for (const std::uint32_t codes : {4096u, 180u}) {
        for (const double rpm : {60.0, 600.0, 2000.0}) {
            SCOPED_TRACE("codes " + std::to_string(codes));
            Sampling sampling{.codes_per_turn = codes, .stamp_delay_s = 100e-6, .missing_one_in = 20};
            const double turns = rpm < 100.0 ? 200.0 : 3000.0;
            const double seconds = turns * 60.0 / rpm;
            CamRig rig(loom, TrueShaft(123.0).jump(rpm * 6.0).hold(seconds), sampling, random.next());
            rig.run_to_the_end();
            expect_once_per_turn(rig, loom, 1);
            for (std::size_t row = 0; row < loom.size(); ++row) {
                const CamKind kind = loom.rows[row].is_window ? CamKind::leave : CamKind::point;
                EXPECT_NEAR(static_cast<double>(rig.count(row, kind)), turns, 2.0) << loom.rows[row].name;
            }
            EXPECT_EQ(rig.schedule.counters().skipped_late, 0u);
            EXPECT_EQ(rig.estimator.counters().resets, 0u);
        }
    }
}

TEST_F(Cams, fires_in_the_order_of_the_effects) {
    CamRig rig(loom, TrueShaft(10.0).jump(3600.0).hold(10.0), {}, random.next());
    rig.run_to_the_end();
    // No dead time separates these two rows: the one at the greater angle fires later.
    ShaftPosition last{-100, {}};
    for (const Fired& fired : rig.fired) {
        if (fired.event.row != 0 && fired.event.row != 5) continue;
        EXPECT_GT(fired.event.target - last, Rotation{});
        last = fired.event.target;
    }
    EXPECT_GT(rig.fired.size(), 800u);
}

TEST_F(Cams, puts_the_effect_on_the_angle_at_even_speeds) {
    for (const std::uint32_t codes : {4096u, 180u}) {
        for (const double rpm : {60.0, 600.0, 1350.0, 2000.0}) {
            Sampling sampling{.codes_per_turn = codes, .stamp_delay_s = 100e-6, .missing_one_in = 50};
            CamRig rig(loom, TrueShaft(17.0).jump(rpm * 6.0).hold(30.0), sampling, random.next());
            rig.run_to_the_end();
            Errors errors;
            for (const Fired& fired : rig.fired)
                if (fired.event.target.turns() > 1) errors.add(effect_error(rig, loom, fired));
            const std::string what =
                std::to_string(static_cast<int>(rpm)) + " rpm, " + std::to_string(codes) + " codes";
            errors.print(what.c_str());
            const double step = 360.0 / codes;
            const double jitter = rpm * 6.0 * 29e-6; // one standard deviation of the stamps
            EXPECT_LT(errors.p50(), 0.3 * step + jitter);
            EXPECT_LT(errors.p99(), 1.0 * step + 4.0 * jitter);
            EXPECT_LT(errors.max(), 2.0 * step + 8.0 * jitter + 0.1);
        }
    }
}

TEST_F(Cams, puts_the_effect_on_the_angle_during_the_run_up) {
    for (const std::uint32_t codes : {4096u, 180u}) {
        Errors errors;
        std::uint64_t skipped = 0;
        for (int run = 0; run < 50; ++run) {
            Sampling sampling{.codes_per_turn = codes, .stamp_delay_s = 100e-6, .missing_one_in = 50};
            const double start = random.unit() * 360.0;
            CamRig rig(loom, TrueShaft(start).hold(0.1).ramp(3600.0, 0.5).hold(0.2), sampling, random.next());
            rig.run(0.8);
            expect_once_per_turn(rig, loom, 1);
            for (const Fired& fired : rig.fired) errors.add(effect_error(rig, loom, fired));
            skipped += rig.schedule.counters().skipped_late;
        }
        const std::string what = "0 to 600 rpm in 0.5 s, " + std::to_string(codes) + " codes";
        errors.print(what.c_str());
        const double step = 360.0 / codes;
        EXPECT_LT(errors.p50(), 0.5 * step + 0.15);
        EXPECT_LT(errors.p99(), 2.0 * step + 0.5);
        EXPECT_LT(errors.max(), 3.0 * step + 1.0);
        EXPECT_EQ(skipped, 0u);
    }
}

TEST_F(Cams, fires_in_both_directions_when_a_row_says_so) {
    constexpr auto table =
        cam_table(700_rpm, cam("both", at(90_deg), direction(Direction::both), dead_time(2ms)),
                  cam("forward", at(90_deg)),
                  cam("backward", at(90_deg), direction(Direction::backward), dead_time(2ms)),
                  cam("window", window(40_deg, 140_deg), direction(Direction::both)));
    // Ten turns forward, a stop, ten turns backward.
    TrueShaft shaft(0.0);
    shaft.hold(0.1)
        .ramp(1800.0, 0.2)
        .hold(1.8)
        .ramp(0.0, 0.2)
        .hold(0.2)
        .ramp(-1800.0, 0.2)
        .hold(1.8)
        .ramp(0.0, 0.2);
    CamRig rig(table, shaft.hold(0.2), {.missing_one_in = 30}, random.next());
    rig.run(shaft.end_s());
    EXPECT_EQ(rig.count(0, CamKind::point), 20u);
    EXPECT_EQ(rig.count(1, CamKind::point), 10u);
    EXPECT_EQ(rig.count(2, CamKind::point), 10u);
    EXPECT_EQ(rig.count(3, CamKind::enter), 20u);
    EXPECT_EQ(rig.count(3, CamKind::leave), 20u);
    for (const Fired& fired : rig.fired) {
        EXPECT_LT(std::fabs(effect_error(rig, table, fired)), 0.5);
        if (fired.event.row != 3) continue;
        const bool entering_end = (fired.event.kind == CamKind::enter) == fired.event.forward;
        EXPECT_EQ(fired.event.target.angle(), entering_end ? Angle{40_deg} : Angle{140_deg});
    }
}

TEST_F(Cams, has_no_due_event_at_standstill) {
    for (const std::uint32_t codes : {4096u, 180u}) {
        CamRig rig(loom, TrueShaft(80.0).hold(5.0), {.codes_per_turn = codes}, random.next());
        rig.run(5.0);
        EXPECT_TRUE(rig.fired.empty());
        EXPECT_EQ(rig.schedule.next_due(), never);
        EXPECT_TRUE(rig.estimator.standing());
    }
}

TEST_F(Cams, does_not_fire_again_when_the_shaft_jitters_at_a_cam) {
    constexpr auto table =
        cam_table(700_rpm, cam("cam", at(90_deg)), cam("both", at(90_deg), direction(Direction::both)));
    TrueShaft shaft(0.0);
    shaft.hold(0.1).ramp(360.0, 0.1).hold(0.2).ramp(0.0, 0.1); // to 108 degrees, 90 is behind it
    for (int i = 0; i < 2; ++i) shaft.ramp(-180.0, 0.1).ramp(0.0, 0.1);
    // Now at 72: over the cam again, forward, then back and forth by a degree around it.
    shaft.ramp(90.0, 0.1).hold(0.1).ramp(0.0, 0.1);
    const double there = shaft.degrees(shaft.end_s());
    ASSERT_NEAR(there, 90.0, 1e-6);
    for (int i = 0; i < 50; ++i)
        shaft.ramp(20.0, 0.05)
            .ramp(0.0, 0.05)
            .ramp(-20.0, 0.1)
            .ramp(0.0, 0.1)
            .ramp(20.0, 0.05)
            .ramp(0.0, 0.05);
    shaft.ramp(180.0, 0.1).ramp(0.0, 0.1);
    CamRig rig(table, shaft, {}, random.next());
    rig.run(shaft.end_s());
    EXPECT_EQ(rig.count(0, CamKind::point), 2u); // once on the way out, once after the return
    EXPECT_EQ(rig.count(1, CamKind::point), 3u);
}

TEST_F(Cams, fires_once_when_the_shaft_stops_between_firing_and_effect) {
    constexpr auto table = cam_table(700_rpm, cam("slow_valve", at(180_deg), dead_time(20ms)));
    // 72 degrees ahead at 600 rpm; braked at 120, the shaft stops at about 160 and continues later.
    CamRig rig(table,
               TrueShaft(-150.0).jump(3600.0).hold(0.075).brake(40.0).hold(0.5).ramp(360.0, 0.05).hold(0.2),
               {}, random.next());
    rig.run_to_the_end();
    EXPECT_EQ(rig.count(0, CamKind::point), 1u);
}

TEST_F(Cams, fires_immediately_and_counts_events_whose_dead_time_has_passed) {
    constexpr auto table = cam_table(700_rpm, cam("valve", at(30_deg), dead_time(10ms), min_speed(300_rpm)));
    // min_speed is reached at about 20 degrees, where the effect is already 18 degrees ahead.
    CamRig rig(table, TrueShaft(0.0).hold(0.1).accelerate(1800.0 * 1800.0 / 40.0, 40.0 / 1800.0).hold(0.3),
               {}, random.next());
    rig.run(0.16);
    ASSERT_EQ(rig.count(0, CamKind::point), 1u);
    EXPECT_EQ(rig.schedule.counters().late, 1u);
    EXPECT_GT(rig.fired[0].event.late_deg, 5.0);
    EXPECT_EQ(rig.schedule.counters().latest_deg, rig.fired[0].event.late_deg);
}

TEST_F(Cams, fires_nothing_below_its_minimum_speed_but_leaves_windows) {
    constexpr auto table = cam_table(700_rpm, cam("point", at(90_deg), min_speed(100_rpm)),
                                     cam("window", window(40_deg, 270_deg), min_speed(100_rpm)));
    TrueShaft shaft(0.0);
    shaft.hold(0.1).ramp(300.0, 0.1).hold(2.4); // two turns at 50 rpm: nothing
    CamRig slow(table, shaft, {}, random.next());
    slow.run(shaft.end_s());
    EXPECT_TRUE(slow.fired.empty());
    EXPECT_EQ(slow.schedule.counters().skipped_slow, 4u);

    TrueShaft braked(-180.0);
    braked.jump(3600.0).hold(0.09).ramp(120.0, 0.01).hold(1.5); // enters at speed, leaves at 20 rpm
    CamRig rig(table, braked, {}, random.next());
    rig.run(braked.end_s());
    EXPECT_EQ(rig.count(1, CamKind::enter), 1u);
    EXPECT_EQ(rig.count(1, CamKind::leave), 1u);
    EXPECT_FALSE(rig.schedule.inside(1));
}

TEST_F(Cams, skips_and_counts_unseen_cams_without_a_burst) {
    for (const double dark_s : {0.03, 0.35, 2.0}) {
        SCOPED_TRACE("dark " + std::to_string(dark_s));
        CamRig rig(loom, TrueShaft(0.0).jump(3600.0).hold(4.0), {}, random.next());
        rig.run(1.0);
        const std::size_t before = rig.fired.size();
        rig.run(1.0 + dark_s, 0.0, 1.0 + dark_s);
        EXPECT_FALSE(rig.estimator.valid(at_s(1.0 + dark_s)));
        rig.run(1.01 + dark_s);
        // 10 ms turn 36 degrees: no more rows can have passed, and two windows may have to be left.
        EXPECT_LE(rig.fired.size() - before, 16u);
        EXPECT_GE(rig.estimator.epoch(), 1u);
        rig.run(4.0);
        EXPECT_GT(rig.fired.size(), 2u * before * 5u / 10u);
        int nozzle = 0;
        for (const Fired& fired : rig.fired) {
            if (fired.event.row != 3) continue;
            nozzle += fired.event.kind == CamKind::enter ? 1 : -1;
            ASSERT_TRUE(nozzle == 0 || nozzle == 1);
        }
    }
}

TEST_F(Cams, leaves_an_open_window_when_the_encoder_returns_elsewhere) {
    constexpr auto table = cam_table(700_rpm, cam("valve", window(60_deg, 120_deg)));
    // At 0.12 s the shaft is at 72 degrees, inside; the encoder is silent until 0.2 s, at 0 degrees.
    CamRig rig(table, TrueShaft(-360.0).jump(3600.0).hold(1.0), {}, random.next());
    rig.run(0.21, 0.12, 0.2);
    ASSERT_EQ(rig.count(0, CamKind::enter), 2u); // also one turn before
    ASSERT_EQ(rig.count(0, CamKind::leave), 2u);
    EXPECT_TRUE(rig.fired.back().event.forced);
    EXPECT_EQ(rig.schedule.counters().forced, 1u);
    EXPECT_FALSE(rig.schedule.inside(0));
    rig.run(1.0);
    EXPECT_EQ(rig.count(0, CamKind::enter), rig.count(0, CamKind::leave));
}

// The valve of a loom: an opened valve is closed when its closing angle will not be reached.
constexpr auto valves =
    cam_table(700_rpm, cam("valve", window(60_deg, 180_deg), dead_time(2500us, 1800us)),
              cam("both", window(60_deg, 180_deg), direction(Direction::both), dead_time(2500us)));

void expect_left_once(const CamRig<2>& rig) {
    for (std::size_t row = 0; row < 2; ++row) {
        EXPECT_EQ(rig.count(row, CamKind::leave), rig.count(row, CamKind::enter)) << valves.rows[row].name;
        EXPECT_FALSE(rig.schedule.inside(row)) << valves.rows[row].name;
    }
}

TEST_F(Cams, leaves_a_window_in_which_the_shaft_stops) {
    TrueShaft shaft(-360.0);
    shaft.jump(3600.0).hold(460.0 / 3600.0).brake(40.0); // from 100 to 140 degrees
    const double stands = shaft.end_s();
    shaft.hold(0.5).ramp(1800.0, 0.1).hold(0.5);
    CamRig rig(valves, shaft, {.missing_one_in = 30}, random.next());
    rig.run(stands + 0.001);
    EXPECT_TRUE(rig.schedule.inside(0));
    rig.run(stands + 0.05);
    expect_left_once(rig);
    EXPECT_EQ(rig.count(0, CamKind::enter), 2u);
    EXPECT_TRUE(rig.fired.back().event.forced);
    rig.run(stands + 0.5);
    EXPECT_EQ(rig.count(0, CamKind::leave), 2u) << "once";
    EXPECT_EQ(rig.schedule.next_due(), never) << "nothing is left to look for";
    rig.run(shaft.end_s());
    const std::size_t open = rig.schedule.inside(0) ? 1 : 0;
    EXPECT_EQ(rig.count(0, CamKind::enter), rig.count(0, CamKind::leave) + open);
    EXPECT_GE(rig.count(0, CamKind::enter), 4u) << "from the next turn on it is entered as before";
}

TEST_F(Cams, leaves_an_anticipated_window_when_the_shaft_stops_before_it) {
    constexpr auto table = cam_table(700_rpm, cam("slow_valve", window(180_deg, 300_deg), dead_time(20ms)));
    // 72 degrees ahead: entered at 108; braked at 120, it stops at 160
    CamRig rig(table, TrueShaft(-150.0).jump(3600.0).hold(0.075).brake(40.0).hold(0.1), {}, random.next());
    rig.run_to_the_end();
    EXPECT_EQ(rig.count(0, CamKind::enter), 1u);
    EXPECT_EQ(rig.count(0, CamKind::leave), 1u);
}

TEST_F(Cams, leaves_a_window_entered_backward_when_the_shaft_stops_in_it) {
    TrueShaft shaft(360.0);
    shaft.hold(0.1).ramp(-1800.0, 0.05).hold(0.1).ramp(0.0, 0.02).hold(0.1); // to 117 degrees
    CamRig rig(valves, shaft, {}, random.next());
    rig.run(shaft.end_s());
    EXPECT_EQ(rig.count(1, CamKind::enter), 1u);
    EXPECT_EQ(rig.count(0, CamKind::enter), 0u);
    expect_left_once(rig);
}

TEST_F(Cams, leaves_a_window_when_the_shaft_turns_back_out_of_it) {
    TrueShaft shaft(0.0);
    shaft.hold(0.1).ramp(1800.0, 0.02).hold(0.045).ramp(-1800.0, 0.02).hold(0.08);
    CamRig rig(valves, shaft, {}, random.next());
    rig.run(shaft.end_s());
    EXPECT_EQ(rig.count(0, CamKind::enter), 1u);
    expect_left_once(rig);
}

TEST_F(Cams, leaves_an_open_window_when_the_encoder_times_out) {
    // At 0.12 s the shaft is at 72 degrees, inside, and continues to turn unseen.
    CamRig rig(valves, TrueShaft(-360.0).jump(3600.0).hold(2.0), {}, random.next());
    rig.run(0.12 + 0.011, 0.12, 1.0); // 8 ms are the maximum age of a sample
    expect_left_once(rig);
    EXPECT_EQ(rig.count(0, CamKind::enter), 2u);
    EXPECT_TRUE(rig.fired.back().event.forced);
    rig.run(1.0, 0.12, 1.0);
    EXPECT_EQ(rig.count(0, CamKind::leave), 2u) << "once";
}

TEST_F(Cams, leaves_all_windows_on_request_exactly_once) {
    CamRig rig(valves, TrueShaft(0.0).jump(3600.0).hold(1.0), {}, random.next());
    rig.run(0.03); // 108 degrees
    ASSERT_TRUE(rig.schedule.inside(0) && rig.schedule.inside(1));
    std::size_t left = 0;
    const auto count = [&left](const CamEvent& event) noexcept
        TAPPET_REALTIME { left += event.kind == CamKind::leave && event.forced ? 1 : 0; };
    rig.schedule.leave_all(count);
    rig.schedule.leave_all(count);
    EXPECT_EQ(left, 2u);
    EXPECT_FALSE(rig.schedule.inside(0) || rig.schedule.inside(1));
}

TEST_F(Cams, keeps_touching_exclusive_windows_apart) {
    constexpr auto table = cam_table(2200_rpm, cam("b", window(120_deg, 240_deg), exclusive("g")),
                                     cam("a", window(0_deg, 120_deg), exclusive("g")),
                                     cam("c", window(240_deg, 0_deg), exclusive("g")));
    static_assert(check(table.view()).empty());
    CamRig rig(table, TrueShaft(10.0).jump(9000.0).hold(3.0), {.codes_per_turn = 180}, random.next());
    rig.run_to_the_end();
    int open = 0;
    for (const Fired& fired : rig.fired) {
        open += fired.event.kind == CamKind::enter ? 1 : -1;
        ASSERT_TRUE(open == 0 || open == 1);
    }
    EXPECT_GT(rig.fired.size(), 400u);
}

// A shaft that accelerates, brakes and reverses at random: enter and leave alternate as on the true shaft.
TEST_F(Cams, pairs_enter_and_leave_for_any_motion) {
    constexpr auto table =
        cam_table(1500_rpm, cam("w", window(50_deg, 170_deg), direction(Direction::both), dead_time(3ms)),
                  cam("v", window(250_deg, 20_deg), direction(Direction::forward), dead_time(1ms, 4ms)));
    for (int run = 0; run < 30; ++run) {
        TrueShaft shaft(random.unit() * 360.0);
        shaft.hold(0.1);
        for (int i = 0; i < 40; ++i) {
            const double speed = random.one_in(3) ? 0.0 : (random.unit() - 0.5) * 12'000.0;
            const double in = 0.1 + random.unit() * 0.3;
            shaft.ramp(speed, in);
            shaft.hold(random.unit() * 0.5);
        }
        const std::uint32_t codes = random.one_in(2) ? 180 : 4096;
        CamRig rig(table, shaft, {.codes_per_turn = codes, .stamp_delay_s = 50e-6, .missing_one_in = 40},
                   random.next());
        rig.run(shaft.end_s());
        for (std::size_t row = 0; row < 2; ++row) {
            bool inside = false;
            for (const Fired& fired : rig.fired) {
                if (fired.event.row != row) continue;
                ASSERT_NE(inside, fired.event.kind == CamKind::enter);
                inside = !inside;
            }
            EXPECT_EQ(inside, rig.schedule.inside(row));
        }
        EXPECT_EQ(rig.schedule.counters().skipped_late, 0u);
        EXPECT_EQ(rig.estimator.counters().resets, 0u);
    }
}

TEST_F(Cams, repeats_bit_for_bit_with_the_same_seed) {
    const auto run = [] {
        CamRig rig(loom, TrueShaft(0.0).hold(0.1).ramp(3600.0, 0.5).hold(1.0).brake(80.0),
                   {.stamp_delay_s = 100e-6, .missing_one_in = 20}, 4711);
        rig.run(1.7);
        std::uint64_t digest = 0;
        for (const Fired& fired : rig.fired) {
            std::uint64_t late = 0;
            std::memcpy(&late, &fired.event.late_deg, sizeof late);
            digest = digest * 0x100000001b3u + static_cast<std::uint64_t>(to_ns(fired.at)) + late +
                     fired.event.row;
        }
        return digest;
    };
    const std::uint64_t once = run();
    EXPECT_EQ(once, run());
    EXPECT_EQ(once, 336675540384717305u) << "another compiler, or another estimator";
}

TEST_F(Cams, fires_nothing_on_a_stale_estimate_even_when_the_timer_is_late) {
    constexpr auto table = cam_table(700_rpm, cam("cam", at(0_deg)));
    CamRig rig(table, TrueShaft(-6.0 - 360.0).jump(3600.0).hold(1.0), {.period_jitter_s = 0.0},
               random.next());
    rig.run(0.1); // 6 degrees before the cam, with one firing a turn ago
    const std::size_t before = rig.fired.size();
    ASSERT_NE(rig.schedule.next_due(), never);
    rig.schedule.advance(at_s(0.12), [](const CamEvent&) noexcept
                         TAPPET_REALTIME { TAPPET_ESCAPE("the test fails", ADD_FAILURE()); });
    EXPECT_EQ(rig.schedule.next_due(), never);
    rig.run(0.2);
    EXPECT_EQ(rig.fired.size(), before + 1) << "the samples go on, and so does the schedule";
}

TEST_F(Cams, does_nothing_before_the_first_samples) {
    CamSchedule schedule(loom);
    const ShaftEstimator estimator{ShaftProperties{}};
    schedule.update(estimator, Time{1s});
    EXPECT_EQ(schedule.next_due(), never);
    schedule.advance(Time{2s}, [](const CamEvent&) noexcept
                     TAPPET_REALTIME { TAPPET_ESCAPE("the test fails", FAIL()); });
}

} // namespace
} // namespace tappet::test
