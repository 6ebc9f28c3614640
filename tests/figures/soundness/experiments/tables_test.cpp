// The four applications are those of the thesis: drifting periods, loads, priorities, and connections.
#include "kernel/machine/instance/instance.hpp"
#include "tests/figures/experiments/applications.hpp"
#include "tests/figures/experiments/wiring.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace tappet::experiments {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;

AcceptedMachine machine_of(std::string_view name) {
    const auto all = applications();
    return std::ranges::find(all, name, &Application::name)->machine();
}

/// Rounded, since each occurs once less.
std::vector<long> occurrences_in_a_second(const MachineView& table) {
    std::vector<long> all;
    for (const ActivityRow& row : table.activities)
        if (row.real_time) all.push_back(std::lround(1 / to_seconds(row.period)) + 1);
    return all;
}

TEST(Applications, have_the_periods_of_the_thesis_once_less_in_each_second) {
    EXPECT_THAT(occurrences_in_a_second(machine_of("minimal").table), ElementsAre(1000));
    EXPECT_THAT(occurrences_in_a_second(machine_of("small").table), ElementsAre(1000, 200));
    EXPECT_THAT(occurrences_in_a_second(machine_of("concurrent").table), ElementsAre(2000, 1000, 500));
    EXPECT_THAT(occurrences_in_a_second(machine_of("large").table), ElementsAre(1000, 200, 100, 20));
}

TEST(Applications, load_the_processor_as_the_thesis_says) {
    const auto load_of = [](std::string_view name) {
        os::Clock clock{os::Clock::Kind::virtual_time};
        const AcceptedMachine machine = machine_of(name);
        MachineInstance instance{machine, clock};
        EXPECT_TRUE(instance.configure({}).has_value());
        double load = 0;
        for (const ActivityRow& row : machine.table.activities)
            if (row.real_time)
                load += to_seconds(instance.find<Task>(row.name)->load.get()) / to_seconds(row.period);
        return load;
    };
    EXPECT_THAT(load_of("minimal"), DoubleNear(0.5, 0.01));
    EXPECT_THAT(load_of("small"), DoubleNear(0.6, 0.01));
    EXPECT_THAT(load_of("concurrent"), DoubleNear(0.55, 0.01));
    EXPECT_THAT(load_of("large"), DoubleNear(0.55, 0.01));
}

TEST(Applications, each_has_one_activity_that_is_not_real_time_below_all_others) {
    for (const Application& application : applications()) {
        const AcceptedMachine machine = application.machine();
        EXPECT_EQ(std::ranges::count(machine.table.activities, false, &ActivityRow::real_time), 1);
        EXPECT_FALSE(machine.table.activities.back().real_time);
        for (std::size_t a = 1; a < machine.table.activities.size(); ++a)
            EXPECT_LT(machine.plan.activities[a].priority, machine.plan.activities[a - 1].priority)
                << application.name << ": rate monotonic";
    }
}

TEST(Applications, the_concurrent_one_has_eight_channels_and_two_neighbours_for_each) {
    const AcceptedMachine machine = machine_of("concurrent");
    const Wiring wiring{machine.table};
    EXPECT_EQ(wiring.channels(), 8u);
    for (std::size_t c = 0; c < machine.table.components.size(); ++c) {
        const LockedPorts& ports = wiring.of(c).ports;
        EXPECT_NE(ports.to_higher, nullptr);
        EXPECT_NE(ports.to_lower, nullptr);
        EXPECT_NE(ports.from_higher, nullptr);
        EXPECT_NE(ports.from_lower, nullptr);
    }
}

TEST(Wiring, connects_each_task_to_the_one_that_its_row_names) {
    const AcceptedMachine machine = machine_of("small");
    const Wiring wiring{machine.table};
    const auto at = [&](std::string_view name) {
        return wiring.of(find_component(machine.table, name)).ports;
    };
    EXPECT_EQ(at("high").to_lower, at("low").from_higher);
    EXPECT_EQ(at("low").to_higher, at("high").from_lower);
    EXPECT_EQ(at("low").to_lower, at("background").from_higher);
    EXPECT_EQ(at("background").to_higher, at("low").from_lower);
    EXPECT_EQ(at("high").from_higher, nullptr) << "the fast loop talks to the slow one only";
    EXPECT_EQ(at("background").from_lower, nullptr);
}

TEST(Wiring, one_writer_with_many_readers_is_one_channel) {
    const AcceptedMachine machine = machine_of("large");
    const Wiring wiring{machine.table};
    const auto* channel = wiring.of(find_component(machine.table, "high")).ports.to_lower;
    for (const char* reader : {"medium", "low", "very_low", "background"})
        EXPECT_EQ(wiring.of(find_component(machine.table, reader)).ports.from_higher, channel) << reader;
}

TEST(Wiring, the_slower_end_moves_a_whole_buffer_and_the_faster_one_a_packet) {
    const AcceptedMachine machine = machine_of("large");
    const Wiring wiring{machine.table};
    const auto at = [&](std::string_view name) { return wiring.of(find_component(machine.table, name)); };
    EXPECT_EQ(at("medium").fill_at_most, 8u);
    EXPECT_EQ(at("high").drain_at_most, 1u);
    EXPECT_EQ(at("background").fill_at_most, 1u);
    EXPECT_EQ(at("very_low").drain_at_most, 8u);
    EXPECT_EQ(at("high").fill_at_most, 0u) << "nobody is above it";
    EXPECT_EQ(at("very_low").ports.fill, at("low").ports.drain);
}

TEST(LockedBuffer, returns_accepted_values_in_order) {
    LockedBuffer<int> buffer{3};
    int got = 0;
    EXPECT_FALSE(buffer.pop(got).done);
    for (int round = 0; round < 4; ++round) { // around its end
        EXPECT_TRUE(buffer.push(1).done);
        EXPECT_TRUE(buffer.push(2).done);
        EXPECT_TRUE(buffer.push(3).done);
        EXPECT_FALSE(buffer.push(4).done);
        for (const int expected : {1, 2, 3}) {
            EXPECT_TRUE(buffer.pop(got).done);
            EXPECT_EQ(got, expected);
        }
        EXPECT_TRUE(buffer.push(5).done);
        EXPECT_TRUE(buffer.pop(got).done);
        EXPECT_EQ(got, 5);
    }
}

TEST(LockedData, returns_the_last_value_and_reports_no_wait) {
    LockedData<int> data;
    EXPECT_FALSE(data.write(1));
    EXPECT_FALSE(data.write(2));
    int got = 0;
    EXPECT_FALSE(data.read(got));
    EXPECT_EQ(got, 2);
}

} // namespace
} // namespace tappet::experiments
