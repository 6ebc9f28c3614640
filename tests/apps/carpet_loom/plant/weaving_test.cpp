// A small machine weaves on the plant: its physics can be controlled, and forbidden events are detected.
#include "tests/apps/carpet_loom/plant/small_machine.hpp"

#include <gtest/gtest.h>

namespace tappet::loom {
namespace {

constexpr std::uint64_t seeds = 8;

Settings quick_hands() { return {.operator_reaction = 200ms}; }

/// The settings with one trouble of the script.
Settings quick_hands(const ScriptedFault& fault) {
    Settings settings = quick_hands();
    EXPECT_TRUE(settings.script.push(fault));
    return settings;
}

/// Runs until the loom is at speed, for the first time or again.
bool runs_up(SmallMachine& machine, Duration at_most = 10s) {
    return machine.run_while([&] { return machine.plant.speed_rpm() < 590.0; }, at_most);
}

TEST(RunUp, takes_less_than_a_second_for_every_loom) {
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        SmallMachine machine(quick_hands(), seed);
        ASSERT_TRUE(machine.run_while([&] { return machine.plant.speed_rpm() < 1.0; }, 10s)) << seed;
        const Time begin = machine.now;
        ASSERT_TRUE(runs_up(machine, 2s)) << seed;
        EXPECT_GT(machine.now - begin, 350ms) << seed;
        EXPECT_LT(machine.now - begin, 850ms) << seed;
    }
}

TEST(Brake, is_learnable_within_a_few_stops) {
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        Settings settings = quick_hands();
        for (std::uint64_t pick = 20; pick <= 160; pick += 20)
            ASSERT_TRUE(settings.script.push({.fault = Fault::weft_break, .at_pick = pick}));
        SmallMachine machine(settings, seed);
        machine.run_until(at_ns(40'000'000'000));
        const Report report = machine.plant.report();
        ASSERT_EQ(report.stops_total, 8U) << seed;
        EXPECT_EQ(report.weft_breaks_injected, 8U);
        for (std::size_t i = 0; i < report.stops.size(); ++i) {
            const Stop& stop = report.stops[i];
            EXPECT_EQ(stop.cause, StopCause::weft) << seed;
            EXPECT_GT(stop.distance_deg, 36.0) << seed;
            EXPECT_LT(stop.distance_deg, 60.0) << seed;
            EXPECT_LT(std::abs(stop.error_deg), i < 2 ? 10.0 : 5.0) << seed << " stop " << i;
        }
    }
}

TEST(Brake, differs_from_loom_to_loom) {
    double least = 360.0;
    double most = 0.0;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        SmallMachine machine(quick_hands({.fault = Fault::operator_stop, .at_pick = 20}), seed);
        ASSERT_TRUE(machine.run_while([&] { return machine.plant.report().stops_total < 1; }, 10s));
        least = std::min(least, machine.plant.report().stops[0].distance_deg);
        most = std::max(most, machine.plant.report().stops[0].distance_deg);
        EXPECT_EQ(machine.plant.report().stops[0].cause, StopCause::operator_stop);
    }
    EXPECT_GT(most - least, 3.0) << "a loom that needs no learning proves nothing";
}

TEST(Weft, arrives_in_its_window) {
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        SmallMachine machine(quick_hands(), seed);
        machine.run_until(at_ns(10'000'000'000));
        ASSERT_GT(machine.arrivals_deg.size(), 50U);
        for (std::size_t i = 0; i < machine.arrivals_deg.size(); ++i) {
            if (machine.arrival_speeds_rpm[i] > 590.0) {
                EXPECT_GT(machine.arrivals_deg[i], 234.5) << seed;
                EXPECT_LT(machine.arrivals_deg[i], 245.5) << seed;
            }
            EXPECT_GT(machine.arrivals_deg[i], wires::nominal::weft_window_begin_deg) << seed;
            EXPECT_LT(machine.arrivals_deg[i], wires::nominal::weft_window_end_deg) << seed;
        }
        const Report report = machine.plant.report();
        EXPECT_EQ(report.damage.total(), 0U);
        EXPECT_LT(report.cam_error_max_deg, 0.5) << "a predicting machine hits its angle";
        EXPECT_GE(report.cam_samples, report.picks);
        EXPECT_NEAR(static_cast<double>(report.picks), static_cast<double>(machine.arrivals_deg.size()), 1.0);
        EXPECT_LE(report.empty_turns, 1U) << "but the one of the first start";
    }
}

TEST(Weft, leaves_an_empty_turn_when_its_break_goes_unnoticed) {
    SmallMachine machine(quick_hands({.fault = Fault::weft_break, .at_pick = 10}), 1);
    machine.checks_weft = false;
    machine.run_until(at_ns(8'000'000'000));
    EXPECT_EQ(machine.plant.report().weft_breaks_injected, 1U);
    EXPECT_EQ(machine.plant.report().empty_turns, 2U);
    EXPECT_EQ(machine.plant.report().stops_total, 0U);
}

TEST(Weft, is_laid_by_hand_after_a_break_before_the_loom_runs) {
    SmallMachine machine(quick_hands({.fault = Fault::weft_break, .at_pick = 10}), 2);
    machine.run_until(at_ns(8'000'000'000));
    EXPECT_EQ(machine.plant.report().picks_by_hand, 1U);
    EXPECT_EQ(machine.plant.report().stops_total, 1U);
    EXPECT_GT(machine.plant.report().picks, 20U);
}

TEST(Weft, fails_when_the_feeder_has_run_empty) {
    SmallMachine machine(quick_hands({.fault = Fault::feeder_empty, .at_pick = 15}), 3);
    machine.run_until(at_ns(12'000'000'000));
    const Report report = machine.plant.report();
    ASSERT_EQ(report.stops_total, 1U);
    EXPECT_EQ(report.stops[0].cause, StopCause::weft);
    EXPECT_EQ(report.weft_breaks_injected, 0U);
    EXPECT_FALSE(machine.plant.feeder().empty()) << "the operator brought a new bobbin";
    EXPECT_GT(report.picks, report.stops[0].at_pick + 10);
}

TEST(WarpBreak, drops_its_wire_until_repaired) {
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        SmallMachine machine(quick_hands({.fault = Fault::warp_break, .at_pick = 20}), seed);
        ASSERT_TRUE(machine.run_while([&] { return !machine.plant.line(wires::line::drop_wire); }, 10s));
        ASSERT_TRUE(machine.run_while([&] { return machine.plant.report().stops_total == 0; }, 1s));
        EXPECT_EQ(machine.plant.report().stops[0].cause, StopCause::warp);
        EXPECT_TRUE(machine.plant.line(wires::line::drop_wire));
        ASSERT_TRUE(runs_up(machine, 5s));
        EXPECT_FALSE(machine.plant.line(wires::line::drop_wire));
        EXPECT_EQ(machine.plant.report().warp_breaks_injected, 1U);
    }
}

TEST(Tension, is_held_in_its_band_by_a_simple_loop) {
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        SmallMachine machine(quick_hands(), seed);
        machine.run_until(at_ns(20'000'000'000));
        const Report report = machine.plant.report();
        EXPECT_GT(report.weaving_s, 10.0);
        EXPECT_EQ(report.tension_out_of_band_s, 0.0) << seed;
        EXPECT_GT(report.tension_most_n - report.tension_least_n, 5.0) << "the shed pulls at the warp";
    }
}

TEST(Tension, causes_damage_when_it_is_not_controlled) {
    SmallMachine machine(quick_hands(), 4);
    ASSERT_TRUE(runs_up(machine));
    machine.holds_tension = false;
    machine.run_until(machine.now + 5s);
    EXPECT_GT(machine.plant.report().damage.tension_high, 0U);
}

TEST(EmergencyStop, brings_the_shaft_to_rest_and_is_timed) {
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        SmallMachine machine(
            quick_hands({.fault = Fault::emergency_stop,
                         .at = at_ns(5'000'000'000 + 7'777'777 * static_cast<std::int64_t>(seed))}),
            seed);
        machine.run_until(at_ns(6'000'000'000));
        const Report report = machine.plant.report();
        ASSERT_EQ(report.emergency_stops, 1U);
        EXPECT_EQ(report.stops[0].cause, StopCause::emergency);
        EXPECT_GT(report.emergency_longest_ms, 7.0);
        EXPECT_LT(report.emergency_longest_ms, 30.0);
        EXPECT_EQ(report.damage.total(), 0U);
        ASSERT_TRUE(runs_up(machine)) << "it weaves on";
    }
}

TEST(EmergencyStop, counts_a_valve_that_is_driven_afterwards) {
    SmallMachine machine(quick_hands(), 5);
    machine.releases = false;
    machine.plant.press(Button::emergency_stop, Duration{});
    machine.plant.set_line(wires::line::weft_release, true, machine.now);
    EXPECT_EQ(machine.plant.report().damage.valve_after_emergency, 1U);
}

TEST(Damage, counts_wefts_in_a_closed_shed_and_second_wefts) {
    SmallMachine machine(quick_hands(), 6);
    machine.releases = false;
    ASSERT_TRUE(runs_up(machine));
    const auto release_at = [&](double deg) {
        while (angle_of_position(machine.plant.position_deg()) > deg) machine.run_until(machine.now + 1ms);
        while (angle_of_position(machine.plant.position_deg()) < deg) machine.run_until(machine.now + 1ms);
        machine.plant.set_line(wires::line::weft_release, true, machine.now);
        machine.run_until(machine.now + 5ms);
        machine.plant.set_line(wires::line::weft_release, false, machine.now);
    };
    release_at(15.0);
    EXPECT_EQ(machine.plant.report().damage.closed_shed_wefts, 1U);
    release_at(70.0);
    EXPECT_EQ(machine.plant.report().damage.double_wefts, 0U);
    release_at(120.0);
    EXPECT_EQ(machine.plant.report().damage.double_wefts, 1U);
}

TEST(Damage, counts_a_shaft_that_coasts) {
    SmallMachine machine(quick_hands(), 7);
    ASSERT_TRUE(runs_up(machine));
    machine.speaks = false;
    machine.plant.receive(MachineSide{}.frame("main_drive_command", {}), machine.now);
    machine.run_until(machine.now + 80ms);
    EXPECT_EQ(machine.plant.report().damage.moved_unpowered, 1U);
}

TEST(Damage, counts_a_motor_driven_against_the_brake_and_the_drive_trips) {
    SmallMachine machine(quick_hands(), 8);
    ASSERT_TRUE(machine.run_while([&] { return machine.state != SmallMachine::State::running; }, 10s));
    machine.plant.set_line(wires::line::brake, true, machine.now);
    machine.run_until(machine.now + 1s);
    EXPECT_EQ(machine.plant.report().damage.motor_blocked, 1U);
    ASSERT_FALSE(machine.emergencies.empty());
    EXPECT_EQ(machine.emergencies[0], wires::emergency_code::motor_blocked);
    EXPECT_EQ(machine.plant.main_drive().state(), DriveState::fault);
}

TEST(SilentMachine, makes_both_drives_stop_the_loom) {
    SmallMachine machine(quick_hands(), 9);
    ASSERT_TRUE(runs_up(machine));
    machine.speaks = false;
    machine.run_until(machine.now + 90ms);
    EXPECT_GT(machine.plant.speed_rpm(), 590.0);
    machine.run_until(machine.now + 900ms);
    EXPECT_EQ(machine.plant.speed_rpm(), 0.0);
    EXPECT_EQ(machine.plant.main_drive().state(), DriveState::fault);
    EXPECT_EQ(machine.plant.let_off_drive().state(), DriveState::fault);
    ASSERT_EQ(machine.emergencies.size(), 2U);
    EXPECT_EQ(machine.emergencies[0], wires::emergency_code::command_lost);
    EXPECT_EQ(machine.plant.report().stops[0].cause, StopCause::fault);
}

TEST(Dobby, takes_every_pattern_and_counts_each_missing_one) {
    SmallMachine machine(quick_hands(), 10);
    machine.run_until(at_ns(6'000'000'000));
    EXPECT_EQ(machine.plant.report().patterns_repeated, 0U);
    EXPECT_GT(machine.plant.dobby().taken(), 20U);
    EXPECT_EQ(machine.plant.dobby().pattern(), machine.plant.dobby().taken());
    machine.repeats_pattern = true;
    machine.run_until(at_ns(7'000'000'000));
    EXPECT_GT(machine.plant.report().patterns_repeated, 5U);
}

TEST(Operator, ends_the_work_at_the_last_pick) {
    SmallMachine machine({.operator_reaction = 200ms, .last_pick = 30}, 11);
    machine.run_until(at_ns(15'000'000'000));
    EXPECT_GE(machine.plant.picks(), 30U);
    EXPECT_LE(machine.plant.picks(), 33U);
    EXPECT_EQ(machine.plant.speed_rpm(), 0.0);
}

Settings all_troubles() {
    return {.weft_break_one_in = 20,
            .warp_break_one_in = 30,
            .operator_stop_one_in = 40,
            .emergency_stop_one_in = 60,
            .operator_reaction = 200ms};
}

TEST(SameSeed, gives_the_same_run_and_another_seed_another) {
    SmallMachine first(all_troubles(), 12);
    SmallMachine second(all_troubles(), 12);
    SmallMachine other(all_troubles(), 13);
    for (SmallMachine* machine : {&first, &second, &other}) machine->run_until(at_ns(20'000'000'000));
    EXPECT_EQ(first.plant.report().digest, second.plant.report().digest);
    EXPECT_NE(first.plant.report().digest, other.plant.report().digest);
    EXPECT_GT(first.plant.report().stops_total, 2U);
}

// Golden values: every compiler and optimisation must give these bits; only a change of the physics changes
// them.
TEST(SameSeed, gives_the_same_run_with_every_compiler) {
    SmallMachine machine(all_troubles(), 2026);
    machine.run_until(at_ns(20'000'000'000));
    EXPECT_EQ(machine.plant.report().digest, 0x451aa1763df6073dU);
}

} // namespace
} // namespace tappet::loom
