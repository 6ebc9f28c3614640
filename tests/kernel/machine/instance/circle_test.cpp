// Parts that need each other's values (a drive's component and its bus) were stopped together and start again
// one by one: the first one starts without its input, as at machine start.
#include "tests/kernel/machine/virtual_rig.hpp"

#include <algorithm>
#include <array>
#include <string>

namespace tappet {
namespace {

struct Relay {
    Input<std::int64_t> in;
    Output<std::int64_t> out;
    std::int64_t steps = 0;
    void step(const Cycle&) noexcept TAPPET_REALTIME { out.write(++steps); }
    static constexpr auto interface() {
        return facets(input<&Relay::in>("in", "", "of the one before"),
                      output<&Relay::out>("out", "", "for the next"));
    }
};

// clang-format off
constexpr auto table = machine("circle",
    components(component<Relay>("bus"), component<Relay>("drive"), component<Relay>("guide"), component<Relay>("reader")),
    activities(
        activity("wires",  every(1ms), runs("bus"),            budget(20us)),
        activity("motion", every(2ms), runs("drive", "guide"), budget(20us)),
        activity("office", every(5ms), runs("reader"),         budget(20us))),
    connections(
        data("bus.out",   "drive.in",  stale_after(20ms), hold),
        data("drive.out", "guide.in",  stale_after(20ms), hold),
        data("guide.out", "bus.in",    stale_after(20ms), hold),
        data("bus.out",   "reader.in", stale_after(20ms), hold)),
    reactions(), behaviours());
// clang-format on

constexpr std::size_t bus = 0, drive = 1, guide = 2, reader = 3;
constexpr std::size_t wires = 0, motion = 1;

struct Circle : testing::Test, RunningRig<table> {
    Circle() { pass(50ms); }
    LifeAnswer change(std::size_t component, LifeChange change) {
        return RunningRig::change(component, change, 50ms);
    }
    LifeOutcome start(std::size_t component) { return change(component, LifeChange::start).outcome; }
};

TEST_F(Circle, starts_its_stopped_components_in_any_order) {
    std::array<std::size_t, 3> order{bus, drive, guide};
    do {
        for (const std::size_t each : order)
            EXPECT_EQ(change(each, LifeChange::stop).outcome, LifeOutcome::done);
        for (const std::size_t each : order)
            EXPECT_EQ(start(each), LifeOutcome::done) << each << " of " << order[0] << order[1] << order[2];
    } while (std::ranges::next_permutation(order).found);
}

TEST_F(Circle, starts_its_stopped_activities_in_any_order) {
    for (const auto& order : {std::array{wires, motion}, std::array{motion, wires}}) {
        for (const std::size_t each : order)
            EXPECT_EQ(world.change_activity(each, LifeChange::stop).view(), "");
        pass(50ms);
        for (const std::size_t each : order) {
            EXPECT_EQ(world.change_activity(each, LifeChange::start).view(), "");
            pass(50ms);
        }
    }
}

TEST_F(Circle, refuses_a_start_while_its_other_part_runs_but_is_silent) {
    EXPECT_EQ(change(drive, LifeChange::stop).outcome, LifeOutcome::done);
    world.hang(wires, clock.now() + 1s);
    pass(50ms);
    const LifeAnswer answer = change(drive, LifeChange::start);
    EXPECT_EQ(answer.refusal, LifeRefusal::input_stale);
    EXPECT_EQ(
        std::string{instance.life().describe(motion, answer).view()},
        "component \"drive\" is not started: its input \"in\" is stale; check that \"bus\" runs and writes "
        "\"bus.out\"; the writer may itself wait for this component: if no value arrives, restart the "
        "machine");
}

TEST_F(Circle, delays_the_start_of_a_reader_outside_it) {
    EXPECT_EQ(change(reader, LifeChange::stop).outcome, LifeOutcome::done);
    EXPECT_EQ(change(bus, LifeChange::stop).outcome, LifeOutcome::done);
    EXPECT_EQ(change(reader, LifeChange::start).refusal, LifeRefusal::input_stale);
    EXPECT_EQ(start(bus), LifeOutcome::done);
    EXPECT_EQ(start(reader), LifeOutcome::done);
}

} // namespace
} // namespace tappet
