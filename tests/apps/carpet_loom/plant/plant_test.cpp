// The plant at its wires: nodes that boot and fall silent, lines, registers, bad input.
#include "apps/carpet_loom/plant/plant.hpp"
#include "tests/apps/carpet_loom/plant/machine_side.hpp"

#include <gtest/gtest.h>

#include <map>
#include <vector>

namespace tappet::loom {
namespace {

constexpr std::uint64_t seeds = 8;

struct Traffic {
    std::map<std::uint32_t, std::vector<can::Frame>> of;
    void fetch(Plant& plant) {
        for (can::Frame sent; plant.transmit(sent);) of[sent.id].push_back(sent);
    }
    void run(Plant& plant, Duration duration) {
        for (const Time end = plant.now() + duration; plant.now() < end;) {
            plant.advance(plant.now() + 1ms);
            fetch(plant);
        }
    }
};

void give(Plant& plant, const std::vector<can::Frame>& frames) {
    for (const can::Frame& frame : frames) plant.receive(frame, plant.now());
}
std::uint8_t state(NmtState as) { return static_cast<std::uint8_t>(as); }

std::int64_t sample_of(const can::Frame& encoder) {
    MachineSide machine;
    EXPECT_EQ(machine.take(encoder), "encoder");
    return machine.integer("encoder", "sample");
}

Settings alone() { return {.operator_present = false}; }

TEST(Nodes, boot_and_send_only_heartbeats_until_they_are_started) {
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        Plant plant(alone(), seed);
        Traffic traffic;
        traffic.run(plant, 200ms);
        EXPECT_EQ(traffic.of.size(), std::size_t{wires::node::count}) << "boot-up messages alone";
        give(plant, configuration(0));
        traffic.run(plant, 1s);
        EXPECT_EQ(traffic.of.size(), 2 * std::size_t{wires::node::count}) << "and answers";
        for (std::uint32_t node = 1; node <= wires::node::count; ++node) {
            const auto& beats = traffic.of[canopen::cob::heartbeat + node];
            ASSERT_GT(beats.size(), 8U);
            EXPECT_EQ(beats[0].data[0], state(NmtState::boot_up));
            EXPECT_EQ(beats[1].data[0], state(NmtState::pre_operational));
            EXPECT_NEAR(to_seconds(beats[2].stamp - beats[1].stamp), 0.1, 1e-5);
        }
    }
}

TEST(Nodes, send_at_their_rates_once_operational) {
    Plant plant(alone(), 1);
    Traffic traffic;
    traffic.run(plant, 200ms);
    give(plant, start(0));
    traffic.of.clear();
    traffic.run(plant, 1s);
    const std::map<std::uint32_t, std::pair<std::size_t, unsigned>> expected{
        {0x181, {500, 6}}, {0x182, {500, 6}}, {0x183, {1000, 4}}, {0x184, {1000, 3}}, {0x185, {100, 3}}};
    for (const auto& [id, rate] : expected) {
        const auto& frames = traffic.of[id];
        EXPECT_NEAR(static_cast<double>(frames.size()), static_cast<double>(rate.first), 1.0)
            << std::hex << id;
        for (const can::Frame& sent : frames) EXPECT_EQ(sent.length, rate.second);
    }
    EXPECT_EQ(traffic.of[0x186].size(), 1U) << "the dobby introduces itself and then speaks on change";
    EXPECT_EQ(traffic.of[0x701].back().data[0], state(NmtState::operational));
    const auto& encoder = traffic.of[0x183];
    for (std::size_t i = 1; i < encoder.size(); ++i)
        EXPECT_EQ(sample_of(encoder[i]), sample_of(encoder[i - 1]) + 1);
}

TEST(Nodes, obey_the_network_one_by_one) {
    Plant plant(alone(), 2);
    Traffic traffic;
    traffic.run(plant, 200ms);
    give(plant, start(wires::node::encoder));
    traffic.run(plant, 50ms);
    EXPECT_FALSE(traffic.of[0x183].empty());
    EXPECT_TRUE(traffic.of[0x184].empty());
    give(plant, configuration(0)); // for the heartbeats
    give(plant, {canopen::nmt_frame(NmtCommand::stop, 0)});
    traffic.fetch(plant);
    traffic.of.clear();
    traffic.run(plant, 200ms);
    EXPECT_TRUE(traffic.of[0x183].empty());
    EXPECT_EQ(traffic.of[0x703].back().data[0], state(NmtState::stopped));
    give(plant, {canopen::nmt_frame(NmtCommand::reset_node, wires::node::encoder)});
    traffic.of.clear();
    traffic.run(plant, 150ms);
    ASSERT_FALSE(traffic.of[0x703].empty());
    EXPECT_EQ(traffic.of[0x703].front().data[0], state(NmtState::boot_up));
}

TEST(Nodes, fall_silent_when_lost_and_boot_again_when_repaired) {
    Plant plant(alone(), 3);
    Traffic traffic;
    traffic.run(plant, 200ms);
    give(plant, start(0));
    traffic.run(plant, 100ms);
    plant.inject({.fault = Fault::node_lost, .node = wires::node::encoder});
    traffic.fetch(plant);
    traffic.of.clear();
    traffic.run(plant, 500ms);
    EXPECT_TRUE(traffic.of[0x183].empty());
    EXPECT_TRUE(traffic.of[0x703].empty());
    EXPECT_FALSE(traffic.of[0x184].empty());
    plant.repair();
    traffic.run(plant, 300ms);
    ASSERT_FALSE(traffic.of[0x703].empty());
    EXPECT_EQ(traffic.of[0x703].front().data[0], state(NmtState::boot_up));
    EXPECT_TRUE(traffic.of[0x183].empty());
}

TEST(Nodes, come_back_by_themselves_after_a_timed_loss) {
    Settings settings = alone();
    ASSERT_TRUE(settings.script.push(
        {.fault = Fault::node_lost, .at = at_ns(300'000'000), .lasts = 400ms, .node = 4}));
    Plant plant(settings, 4);
    Traffic traffic;
    traffic.run(plant, 2s);
    const auto& beats = traffic.of[0x704];
    std::vector<Time> boots;
    for (const can::Frame& sent : beats)
        if (sent.data[0] == state(NmtState::boot_up)) boots.push_back(sent.stamp);
    ASSERT_EQ(boots.size(), 2U);
    EXPECT_NEAR(to_seconds(boots[1] - Time{}), 0.8, 0.02);
}

TEST(BadInput, changes_nothing) {
    Plant plant(alone(), 5);
    Traffic traffic;
    traffic.run(plant, 200ms);
    for (std::uint32_t id = 0; id < 0x800; ++id) {
        can::Frame frame;
        frame.id = id;
        frame.length = static_cast<std::uint8_t>(id % 2);
        plant.receive(frame, plant.now());
    }
    give(plant, {canopen::nmt_frame(NmtCommand::start, 77), canopen::nmt_frame(NmtCommand{0x55}, 0)});
    give(plant, configuration(1)); // a heartbeat shows its state
    for (const unsigned line : {0U, 3U, 6U, 7U, 14U, 4'000'000'000U}) {
        plant.set_line(line, true, plant.now());
        EXPECT_FALSE(plant.line(line));
    }
    traffic.run(plant, 200ms);
    EXPECT_EQ(traffic.of[0x701].back().data[0], state(NmtState::pre_operational));
    EXPECT_EQ(plant.speed_rpm(), 0.0);
    EXPECT_EQ(plant.report().damage.total(), 0U);
}

TEST(BadInput, is_taken_as_now_when_its_time_has_passed) {
    Plant plant(alone(), 6);
    plant.advance(at_ns(500'000'000));
    plant.advance(at_ns(100));
    plant.set_line(wires::line::brake, true, at_ns(100));
    EXPECT_EQ(plant.now(), at_ns(500'000'000));
}

TEST(Frames, are_counted_when_nobody_fetches_them) {
    Plant plant(alone(), 7);
    plant.advance(at_ns(200'000'000));
    give(plant, start(0));
    plant.advance(at_ns(20'000'000'000));
    EXPECT_GT(plant.report().frames_lost, 0U);
}

TEST(Buttons, bounce_and_settle_where_they_were_put) {
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        Plant plant(alone(), seed);
        plant.advance(at_ns(1'000'000));
        plant.press(Button::start, 100ms);
        bool level = false;
        Time last{};
        int edges = 0;
        const auto fetch = [&] {
            Edge edge;
            while (plant.next_edge(edge)) {
                EXPECT_EQ(edge.line, wires::line::button_start);
                EXPECT_NE(edge.level, level);
                EXPECT_GE(edge.at, last);
                level = edge.level;
                last = edge.at;
                ++edges;
            }
        };
        plant.advance(at_ns(50'000'000));
        fetch();
        EXPECT_TRUE(level);
        EXPECT_TRUE(plant.line(wires::line::button_start));
        plant.advance(at_ns(200'000'000));
        fetch();
        EXPECT_FALSE(level);
        EXPECT_EQ(edges % 2, 0);
    }
}

TEST(EmergencyStop, stays_pressed_until_it_is_released) {
    Plant plant(alone(), 8);
    plant.press(Button::emergency_stop, Duration{});
    plant.advance(at_ns(5'000'000'000));
    EXPECT_TRUE(plant.line(wires::line::emergency_stop));
    plant.repair();
    plant.advance(at_ns(5'100'000'000));
    EXPECT_FALSE(plant.line(wires::line::emergency_stop));
}

TEST(Advancing, gives_the_same_run_in_small_and_large_steps) {
    Settings settings = alone();
    ASSERT_TRUE(settings.script.push({.fault = Fault::oil_lost, .at = at_ns(700'000'000)}));
    Plant often(settings, 9);
    Plant rarely(settings, 9);
    for (Time now{}; now < at_ns(1'000'000'000); now += 37us) often.advance(now);
    for (Plant* plant : {&often, &rarely}) {
        plant->advance(at_ns(1'000'000'000));
        give(*plant, start(0));
        plant->set_line(wires::line::brake, true, at_ns(1'000'500'123));
    }
    while (often.now() < at_ns(2'000'000'000)) often.advance(often.next_event());
    rarely.advance(often.now());
    EXPECT_EQ(often.report().digest, rarely.report().digest);
}

TEST(Climate, builds_oil_pressure_with_the_pump_and_loses_it_by_a_fault) {
    Plant plant(alone(), 10);
    plant.climate().set_pump(true);
    plant.advance(at_ns(2'000'000'000));
    EXPECT_GT(plant.climate().oil_bar(), 2.0);
    plant.inject({.fault = Fault::oil_lost});
    plant.advance(at_ns(7'000'000'000));
    EXPECT_LT(plant.climate().oil_bar(), 0.5);
    plant.repair();
    plant.advance(at_ns(9'500'000'000));
    EXPECT_GT(plant.climate().oil_bar(), 2.0);
}

} // namespace
} // namespace tappet::loom
