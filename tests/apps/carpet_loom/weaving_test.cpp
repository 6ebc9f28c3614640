// The carpet loom weaves, over many seeds: inertia, brake, yarn and the moments of the faults differ from
// seed to seed.
#include "tests/apps/carpet_loom/loom_rig.hpp"

#include <algorithm>
#include <cmath>

namespace tappet::carpet {
namespace {

using loom::Fault;

class Weaving : public testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(seed, Weaving, seeds(4));

double mean_size_of_errors(const loom::Report& report, std::size_t from, std::size_t to) {
    double sum = 0.0;
    for (std::size_t i = from; i < to; ++i) sum += std::abs(report.stops[i].error_deg);
    return sum / static_cast<double>(to - from);
}

TEST_P(Weaving, prepares_runs_up_weaves_and_obeys_the_operators_stop) {
    LoomRig rig{GetParam(), {.last_pick = 30}};
    EXPECT_TRUE(rig.run_until_state("ready", 5s));
    EXPECT_FALSE(rig.output(wires::line::lamp_run));
    EXPECT_TRUE(rig.run_until_state("run_up", 5s));
    EXPECT_TRUE(rig.run_until_state("weave", 3s));
    EXPECT_TRUE(rig.run().weave(30, 20s));
    EXPECT_TRUE(rig.run_until_state("ready", 1s)); // only time shows that a shaft stands
    EXPECT_EQ(rig.cause(), StopCause::operator_stop);
    EXPECT_EQ(rig.reason(), "the operator pressed stop");
    EXPECT_TRUE(rig.output(wires::line::lamp_stop));
    const loom::Report report = rig.report();
    EXPECT_EQ(report.stops_total, 1u);
    expect_stops_in_tolerance(report);
    expect_no_damage(report);
}

TEST_P(Weaving, stops_for_broken_wefts_and_warp_ends_within_ten_degrees_of_the_stop_angle) {
    LoomRig rig{
        GetParam(),
        {.weft_break_one_in = 12, .warp_break_one_in = 25, .operator_stop_one_in = 60, .last_pick = 200}};
    ASSERT_TRUE(rig.run().weave(200, 400s)) << rig.told();
    const loom::Report report = rig.report();
    ASSERT_GE(report.stops.size(), 6u);
    expect_stops_in_tolerance(report);
    expect_no_damage(report);
    EXPECT_GT(report.weft_breaks_injected, 0u);
    EXPECT_GT(report.warp_breaks_injected, 0u);
    // The operator lays a missing weft by hand; the only gap in the cloth is in the parked first turn.
    EXPECT_LE(report.picks_by_hand, report.weft_breaks_injected);
    EXPECT_LE(report.empty_turns, 1u);
    EXPECT_EQ(report.patterns_repeated, 0u);
    std::uint64_t picks_lifted = 0;
    for (const loom::LiftedPattern& each : report.patterns) picks_lifted += each.picks;
    EXPECT_EQ(report.patterns.size(), 3u);
    EXPECT_GE(picks_lifted, report.picks);
    EXPECT_EQ(rig.component<MainShaft>("shaft").stops.last() > 0, true);
    EXPECT_EQ(rig.run().instance().observation().lost_emissions(), 0u);
}

TEST_P(Weaving, learns_the_brake_from_its_stops) {
    LoomRig rig{GetParam(), {.weft_break_one_in = 6, .last_pick = 150}};
    ASSERT_TRUE(rig.run().weave(150, 400s)) << rig.told();
    const loom::Report report = rig.report();
    ASSERT_GE(report.stops.size(), 9u);
    // The machine trusts the data sheet for the first stop only; afterwards it uses the brake distances that
    // the plant measured.
    const std::size_t last = report.stops.size();
    EXPECT_LE(mean_size_of_errors(report, last / 2, last), 1.5);
    const double believed = rig.component<MainShaft>("shaft").brake_distance_deg.last();
    std::array<double, loom::Report::most_stops> measured{};
    std::size_t n = 0;
    for (std::size_t i = last / 2; i < last; ++i)
        if (report.stops[i].distance_deg > 0.0) measured[n++] = report.stops[i].distance_deg;
    ASSERT_GT(n, 0u);
    std::nth_element(measured.begin(), measured.begin() + static_cast<std::ptrdiff_t>(n / 2),
                     measured.begin() + static_cast<std::ptrdiff_t>(n));
    EXPECT_NEAR(believed, measured[n / 2], 4.0);
}

TEST_P(Weaving, follows_a_brake_that_wears) {
    // All wear happens within twenty stops.
    LoomRig rig{GetParam(), {.weft_break_one_in = 6, .last_pick = 150, .brake_wear_per_stop = 0.008}};
    ASSERT_TRUE(rig.run().weave(150, 400s)) << rig.told();
    const loom::Report report = rig.report();
    expect_stops_in_tolerance(report);
    EXPECT_LE(mean_size_of_errors(report, report.stops.size() / 2, report.stops.size()), 2.0);
}

TEST_P(Weaving, opens_the_valve_at_its_angle) {
    LoomRig rig{GetParam(), {.last_pick = 100}};
    ASSERT_TRUE(rig.run().weave(100, 60s));
    const loom::Report report = rig.report();
    EXPECT_GE(report.cam_samples, 100u);
    EXPECT_LE(report.cam_error_max_deg, 0.5);
    EXPECT_NEAR(rig.component<WeftInsertion>("weft").arrival_deg.last(), wires::nominal::weft_arrival_deg,
                30.0);
}

TEST_P(Weaving, holds_the_warps_tension) {
    LoomRig rig{GetParam(), {.last_pick = 100}};
    ASSERT_TRUE(rig.run().weave(100, 60s));
    const loom::Report report = rig.report();
    EXPECT_EQ(report.tension_out_of_band_s, 0.0);
    EXPECT_GT(report.tension_least_n, wires::nominal::tension_n - wires::nominal::tension_band_n);
    EXPECT_LT(report.tension_most_n, wires::nominal::tension_n + wires::nominal::tension_band_n);
}

TEST_P(Weaving, counts_the_picks_that_the_plant_counts) {
    LoomRig rig{GetParam(), {.last_pick = 60}};
    ASSERT_TRUE(rig.run().weave(60, 60s));
    const auto counted = rig.component<WeftInsertion>("weft").picks_woven.last();
    EXPECT_NEAR(static_cast<double>(counted), static_cast<double>(rig.plant().picks()),
                1.0); // the last stands in the shed
}

} // namespace
} // namespace tappet::carpet
