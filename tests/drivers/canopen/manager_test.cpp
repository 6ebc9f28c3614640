// The manager of a network: which nodes it starts, how it configures them, and what it reports about the
// others.
#include "tests/drivers/canopen/network_machine.hpp"

#include <gtest/gtest.h>

namespace tappet::test {
namespace {

using canopen::Identity;
using canopen::NodePhase;
using canopen::SdoAbort;

struct Network : testing::Test, NetworkRig {
    ~Network() override {
        EXPECT_TRUE(good);
        EXPECT_EQ(refused, 0) << "frames of the nodes";
    }
};

struct WorkingNetwork : Network {
    void SetUp() override { run_until(500ms); }
};

TEST_F(Network, checks_configures_and_starts_its_nodes) {
    run_until(400ms);
    EXPECT_TRUE(operational()) << reason();
    EXPECT_EQ(reason(), "");
    EXPECT_EQ(starts, 2);
    EXPECT_EQ(drive.get({0x1800, 1}), 0x40000185u);
    EXPECT_EQ(drive.get({0x1800, 5}), 5u);
    EXPECT_EQ(drive.get({0x1A00, 0}), 2u);
    EXPECT_EQ(drive.get({0x1A00, 1}), 0x60410010u);
    EXPECT_EQ(drive.get({0x1A00, 2}), 0x606C0020u);
    EXPECT_EQ(drive.get({0x1600, 2}), 0x60FF0020u);
    EXPECT_EQ(drive.get(0x6060), 3u);
    EXPECT_EQ(drive.get(0x1017), 50u);
    EXPECT_EQ(drive.get({0x1016, 1}), 127u << 16 | 350u);
    EXPECT_EQ(encoder.get({0x1800, 2}), 1u);
}

TEST_F(WorkingNetwork, exchanges_mapped_process_data) {
    EXPECT_EQ(people->statusword.get(), 0x231);
    EXPECT_EQ(people->velocity.get(), -1234 * 0.1);
    EXPECT_EQ(people->position.get(), 0xABC);
    EXPECT_EQ(drive.get(0x6040), 6u);
    EXPECT_EQ(drive.get_signed(0x60FF), -123);
}

TEST_F(Network, produces_sync_time_and_its_heartbeat) {
    run_until(3s);
    const auto syncs = heard_of(0x080);
    ASSERT_GE(syncs.size(), 290u);
    for (std::size_t i = 0; i < syncs.size(); ++i) {
        ASSERT_EQ(syncs[i].length, 1);
        ASSERT_EQ(syncs[i].data[0], i % 20 + 1);
        if (i != 0) {
            ASSERT_LT(syncs[i].stamp - syncs[i - 1].stamp, 10ms + 1ms);
        }
    }
    const auto beats = heard_of(0x77F);
    ASSERT_GE(beats.size(), 29u);
    EXPECT_EQ(beats[0].data[0], 0x00);
    EXPECT_EQ(beats[1].data[0], 0x05);
    const auto times = heard_of(0x100);
    ASSERT_GE(times.size(), 2u);
    EXPECT_EQ(times[0].length, 6);
    EXPECT_EQ(times[0].data[4] | times[0].data[5] << 8, 366) << "the second day of 1985";
    EXPECT_GE(times[0].data[0] | times[0].data[1] << 8, 1500);
}

TEST_F(Network, refuses_another_device_and_names_the_expected_one) {
    drive.replace({.device_type = 0x00020192, .vendor = 0x3E7, .product = 0x403, .revision = 0x00010002});
    run_until(2s);
    EXPECT_FALSE(operational());
    EXPECT_EQ(phase(0), NodePhase::refused);
    EXPECT_EQ(phase(1), NodePhase::operational) << "the others wait for nobody";
    EXPECT_EQ(reason(), "node 5 \"drive\": object 1018h:2 must be 00000402h and is 00000403h; connect a "
                        "\"Velocity drive\" as apps/carpet_loom/nodes/drive.eds describes it");
    EXPECT_EQ(drive.get({0x1800, 5}), 0u) << "nothing was written to it";
    drive.replace(drive.dictionary().identity);
    drive.power_on(clock.now() + 100ms);
    run(500ms);
    EXPECT_TRUE(operational()) << reason();
}

TEST_F(Network, refuses_a_device_that_does_not_keep_its_mapping) {
    drive.lose_writes({0x1A00, 2});
    run_until(1s);
    EXPECT_FALSE(operational());
    EXPECT_EQ(reason(),
              "node 5 \"drive\": object 1A00h:2 was to be 606C0020h and reads 00000000h; the device does "
              "not take this configuration: correct the network's table");
    EXPECT_EQ(people->statusword.get(), 0) << "it was never started";
}

TEST_F(Network, reports_the_abort_code_of_a_device_that_refuses) {
    drive.refuse(0x605A, SdoAbort::too_high);
    run_until(1s);
    EXPECT_EQ(
        reason(),
        "node 5 \"drive\": object 605Ah:0 was not written, abort 06090031h (value of parameter written too "
        "high); correct the network's table or apps/carpet_loom/nodes/drive.eds");
    EXPECT_EQ(phase(0), NodePhase::refused);
}

TEST_F(Network, retries_a_device_that_cannot_be_configured_yet) {
    drive.refuse(0x605A, SdoAbort::device_state);
    run_until(1s);
    EXPECT_EQ(
        reason(),
        "node 5 \"drive\": object 605Ah:0 was not written, abort 08000022h (data cannot be transferred "
        "or stored to the application because of the present device state); it is asked again: look at the "
        "device");
    EXPECT_EQ(phase(0), NodePhase::lost);
    drive.refuse(0x605A, SdoAbort::none);
    run(1500ms);
    EXPECT_TRUE(operational()) << reason();
}

TEST_F(Network, waits_for_a_node_that_does_not_answer) {
    encoder.power_off();
    run_until(3s);
    EXPECT_FALSE(operational());
    EXPECT_EQ(reason(),
              "node 7 \"encoder\": it does not answer; look at its supply, its identifier and the bit rate");
    EXPECT_EQ(manager->silent_node.last(), 7);
    encoder.power_on(clock.now() + 10ms);
    run(300ms);
    EXPECT_TRUE(operational()) << reason();
}

TEST_F(Network, polls_a_node_whose_boot_up_was_missed) {
    run_until(50ms);
    encoder.cut_off(true); // its boot-up is lost, and it has no heartbeat by itself
    run_until(200ms);
    encoder.cut_off(false);
    run_until(2500ms);
    EXPECT_TRUE(operational()) << reason();
}

TEST_F(WorkingNetwork, restores_a_node_after_a_broken_cable) {
    encoder.cut_off(true);
    run(200ms);
    EXPECT_FALSE(operational());
    EXPECT_EQ(phase(1), NodePhase::lost);
    EXPECT_EQ(manager->silent_node.last(), 7);
    EXPECT_EQ(reason(), "node 7 \"encoder\": its heartbeat is missing; look at its supply and its cable");
    encoder.cut_off(false);
    run(400ms);
    EXPECT_TRUE(operational()) << reason();
    EXPECT_EQ(starts, 3) << "it was led back and started again";
}

TEST_F(WorkingNetwork, configures_a_node_again_after_it_rebooted) {
    drive.power_on(clock.now() + 5ms);
    run(8ms);
    EXPECT_FALSE(operational());
    EXPECT_EQ(reason(), "node 5 \"drive\": it booted again while it worked; look at its supply");
    run(400ms);
    EXPECT_TRUE(operational()) << reason();
    EXPECT_EQ(manager->reboots.last(), 1);
    EXPECT_EQ(drive.get({0x1A00, 0}), 2u);
}

TEST_F(WorkingNetwork, refuses_a_node_that_was_replaced_while_absent) {
    drive.power_off();
    run(500ms);
    drive.replace({.device_type = 0x00020192, .vendor = 0x3E8, .product = 0x402, .revision = 0x00010002});
    drive.power_on(clock.now() + 100ms);
    run(1s);
    EXPECT_FALSE(operational());
    EXPECT_EQ(phase(0), NodePhase::refused);
    EXPECT_NE(reason().find("1018h:1 must be 000003E7h and is 000003E8h"), std::string::npos) << reason();
}

TEST_F(Network, takes_over_a_node_that_another_master_started) {
    drive.refuse(0x605A, SdoAbort::general);
    run_until(500ms);
    ASSERT_EQ(phase(0), NodePhase::refused);
    can::Frame start = canopen::nmt_frame(canopen::NmtCommand::start, 5);
    drive.receive(start, clock.now(), *this);
    ASSERT_TRUE(drive.operational());
    // The heartbeat was not written yet when it was refused.
    drive.set(0x1017, 50);
    can::Frame beat = canopen::heartbeat_frame(5, canopen::NmtState::operational);
    send(beat);
    run(20ms);
    EXPECT_FALSE(drive.operational());
}

TEST_F(WorkingNetwork, restarts_a_node_that_left_the_operational_state) {
    drive.receive(canopen::nmt_frame(canopen::NmtCommand::enter_pre_operational, 5), clock.now(), *this);
    run(60ms);
    EXPECT_FALSE(operational());
    EXPECT_EQ(reason(), "node 5 \"drive\": it left its operational state by itself; look at its errors");
    run(300ms);
    EXPECT_TRUE(operational());
}

TEST_F(WorkingNetwork, reports_and_keeps_emergencies) {
    drive.send_emergency(0x2310, 0x03, clock.now(), *this);
    run(10ms);
    ASSERT_EQ(people->emergencies.size(), 1u);
    EXPECT_EQ(people->emergencies[0], (std::array<std::int64_t, 3>{5, 0x2310, 3}));
    EXPECT_EQ(manager->errors[0].last(), 0x2310);
    for (int i = 0; i < 20; ++i) {
        drive.send_emergency(static_cast<std::uint16_t>(0x8000 + i), 1, clock.now(), *this);
        run(10ms);
    }
    drive.send_emergency(0, 0, clock.now(), *this);
    run(10ms);
    EXPECT_EQ(manager->errors[0].last(), 0);
    ASSERT_EQ(manager->emergencies().size(), 16u);
    EXPECT_EQ(manager->emergencies()[15].code, 0);
    EXPECT_EQ(manager->emergencies()[14].code, 0x8013);
}

TEST_F(WorkingNetwork, is_monitored_by_its_nodes_for_the_loss_of_the_manager) {
    const Sentence refusal = world.change_activity(1, LifeChange::stop);
    ASSERT_TRUE(refusal.empty()) << refusal.view();
    run(500ms);
    EXPECT_EQ(drive.get({0x1003, 1}), 0x8130u);
    EXPECT_FALSE(drive.operational());
}

TEST_F(WorkingNetwork, makes_its_nodes_safe_at_the_stop_before_they_leave_operational) {
    ASSERT_TRUE(operational());
    heard.clear();
    world.stop();
    run(20ms);
    ASSERT_GE(heard.size(), 3u);
    const can::Frame *const command = &heard[heard.size() - 3], *const sync = command + 1,
                            *const nmt = sync + 1;
    EXPECT_EQ(command->id, 0x205u);
    EXPECT_EQ(command->data[0], 2) << "a quick stop, by the map; its writer has no stop()";
    EXPECT_EQ(sync->id, 0x080u) << "what was told counts with it";
    EXPECT_EQ(nmt->id, 0x000u);
    EXPECT_EQ(nmt->data[0], 0x80);
    EXPECT_FALSE(manager->operational.last());
    EXPECT_EQ(phase(0), NodePhase::absent);
}

TEST_F(WorkingNetwork, lets_an_operator_reset_one_node) {
    manager->reset(7);
    run(20ms);
    EXPECT_FALSE(encoder.alive());
    run(400ms);
    EXPECT_TRUE(operational());
    EXPECT_EQ(manager->reboots.last(), 1);
}

TEST_F(WorkingNetwork, drops_a_reset_requested_before_its_stop) {
    static_cast<void>(world.change_activity(1, LifeChange::stop));
    manager->reset(7); // requested in its last cycle, and not yet sent
    run(2s);
    heard.clear();
    static_cast<void>(world.change_activity(1, LifeChange::start));
    run(20ms);
    for (const can::Frame& each : heard) EXPECT_FALSE(each.id == 0 && each.data[0] == 0x81) << "reset node";
}

TEST_F(WorkingNetwork, survives_unexpected_frames) {
    for (const std::uint32_t id : {0x585u, 0x705u, 0x085u})
        for (std::uint8_t length = 0; length <= 8; ++length) {
            can::Frame frame{.id = id, .length = length};
            frame.data.fill(0xFF);
            if (id == 0x705 && length == 1) continue;
            send(frame);
        }
    run(100ms);
    EXPECT_TRUE(operational()) << reason();
    EXPECT_EQ(manager->wrong_lengths.last(), 24) << "8 of each sort";
}

} // namespace
} // namespace tappet::test
