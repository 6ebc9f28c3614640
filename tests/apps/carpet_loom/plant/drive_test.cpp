// The CiA 402 state machine of the plant's drives, transition by transition; numbers are the standard's.
#include "apps/carpet_loom/plant/drive.hpp"
#include "tests/apps/carpet_loom/plant/machine_side.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace tappet::loom {
namespace {

struct TestDrive : testing::Test {
    TestDrive() {
        static_cast<void>(drive.node().tick(now, out));
        for (const can::Frame& frame : start(wires::node::main_drive)) hear(frame);
        static_cast<void>(sent());
        EXPECT_EQ(drive.state(), DriveState::not_ready);
        supervise(true); // transition 1
    }
    void supervise(bool standing) { drive.supervise(standing, true, false, now, out); }
    DriveState give(std::uint16_t word) {
        now += 1ms;
        hear(machine.frame("main_drive_command", {{"controlword", word}, {"velocity", 6000}}));
        return drive.state();
    }
    void hear(const can::Frame& frame) {
        if (drive.node().receive(frame, now, out) == canopen::SimulatedNode::Heard::process_data)
            drive.command(now, out);
    }
    void enable() {
        give(0x06);
        give(0x07);
        ASSERT_EQ(give(0x0F), DriveState::operation_enabled);
    }
    std::vector<can::Frame> sent() {
        std::vector<can::Frame> frames;
        for (can::Frame frame; out.pop(frame);) frames.push_back(frame);
        return frames;
    }
    Random random{1};
    Wire out;
    MachineSide machine;
    Time now = at_ns(200'000'000); // every node has booted
    Drive drive{wires::node::main_drive, wires::main_velocity_per_rpm, random};
};

using Faulty = TestDrive;

TEST_F(Faulty, reacts_to_a_fault_13_and_rests_in_it_14) {
    enable();
    static_cast<void>(sent());
    drive.trip(wires::emergency_code::over_current, now, out);
    EXPECT_EQ(drive.statusword() & 0x4F, 0x0F);
    EXPECT_EQ(drive.power(), Power::stop);
    const auto frames = sent();
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_EQ(frames[0].id, 0x081U);
    EXPECT_EQ(frames[0].length, 8U);
    EXPECT_EQ(emergency_of(frames[0]), (Emergency{wires::emergency_code::over_current, 0x01}));
    supervise(true);
    EXPECT_EQ(drive.statusword() & 0x4F, 0x08);
    EXPECT_EQ(drive.power(), Power::off);
}
TEST_F(Faulty, resets_a_fault_on_the_rising_edge_of_bit_7_only_15) {
    give(0x80); // the bit is already high when the fault comes
    drive.trip(wires::emergency_code::over_current, now, out);
    supervise(true);
    EXPECT_EQ(give(0x80), DriveState::fault);
    EXPECT_EQ(give(0x0F), DriveState::fault);
    static_cast<void>(sent());
    EXPECT_EQ(give(0x80), DriveState::switch_on_disabled);
    const auto frames = sent();
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_EQ(emergency_of(frames[0]), (Emergency{canopen::emergency_code::error_reset, 0x00}));
}
TEST_F(Faulty, is_not_reset_before_the_reaction_has_ended) {
    enable();
    drive.trip(wires::emergency_code::over_current, now, out);
    supervise(false);
    EXPECT_EQ(give(0x80), DriveState::fault_reaction_active);
}

using SilentMachine = TestDrive;

TEST_F(SilentMachine, stops_an_enabled_drive_after_its_time_out_and_not_before) {
    enable();
    static_cast<void>(sent());
    now += 100ms;
    supervise(false);
    EXPECT_EQ(drive.state(), DriveState::operation_enabled);
    now += 1us;
    supervise(false);
    EXPECT_EQ(drive.state(), DriveState::fault_reaction_active);
    const auto frames = sent();
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_EQ(emergency_of(frames[0]), (Emergency{wires::emergency_code::command_lost, 0x11}));
}
TEST_F(SilentMachine, does_not_trip_a_drive_that_is_not_switched_on) {
    give(0x06);
    now += 1s;
    supervise(true);
    EXPECT_EQ(drive.state(), DriveState::ready_to_switch_on);
}

using BadFrames = TestDrive;

TEST_F(BadFrames, get_an_emergency_message_for_a_wrong_length_and_change_nothing) {
    give(0x06);
    static_cast<void>(sent());
    can::Frame cut = machine.frame("main_drive_command", {{"controlword", 0x07}});
    cut.length = 5;
    hear(cut);
    EXPECT_EQ(drive.state(), DriveState::ready_to_switch_on);
    const auto frames = sent();
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_EQ(emergency_of(frames[0]).code, canopen::emergency_code::pdo_too_short);
}
TEST_F(BadFrames, are_ignored_outside_the_operational_state) {
    hear(canopen::nmt_frame(NmtCommand::enter_pre_operational, 0));
    EXPECT_EQ(give(0x06), DriveState::switch_on_disabled);
}

TEST_F(BadFrames, move_nothing_when_they_select_an_unknown_mode) {
    enable();
    EXPECT_EQ(drive.target(), 6000);
    drive.node().set(0x6060, 8);
    give(0x0F);
    EXPECT_EQ(drive.target(), 0);
}

} // namespace
} // namespace tappet::loom
