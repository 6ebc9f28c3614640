// The CiA 402 state machine of the plant's drives, transition by transition; numbers are the standard's.
#include "apps/carpet_loom/plant/drive.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace tappet::loom {
namespace {

struct TestDrive : testing::Test {
    TestDrive() {
        static_cast<void>(drive.node().tick(now, out));
        static_cast<void>(drive.node().network_management(wires::nmt_command::start, 1, now));
        EXPECT_EQ(drive.state(), DriveState::not_ready);
        supervise(true); // transition 1
    }
    void supervise(bool standing) { drive.supervise(standing, true, false, now, out); }
    DriveState give(std::uint16_t word) {
        now += 1ms;
        drive.command(FrameWriter(wires::cob::main_drive_command).u16(word).i32(6000).frame(), now, out);
        return drive.state();
    }
    void enable() {
        give(0x06);
        give(0x07);
        ASSERT_EQ(give(0x0F), DriveState::operation_enabled);
    }
    std::vector<CanFrame> sent() {
        std::vector<CanFrame> frames;
        SentFrame frame;
        while (out.pop(frame)) frames.push_back(frame.frame);
        return frames;
    }
    Random random{1};
    FrameOutbox out;
    Time now = at_ns(200'000'000); // every node has booted
    Drive drive{wires::node::main_drive, random};
};

struct Transition : TestDrive {
    void expect(std::uint16_t word, DriveState state, unsigned mask, unsigned status) {
        EXPECT_EQ(give(word), state) << std::hex << word;
        EXPECT_EQ(drive.statusword() & mask, status) << std::hex << drive.statusword();
    }
};

TEST_F(Transition, goes_up_step_by_step_2_3_4) {
    EXPECT_EQ(drive.statusword() & 0x4F, 0x40);
    expect(0x06, DriveState::ready_to_switch_on, 0x6F, 0x21);
    EXPECT_EQ(drive.power(), Power::off);
    expect(0x07, DriveState::switched_on, 0x6F, 0x23);
    EXPECT_EQ(drive.power(), Power::off);
    expect(0x0F, DriveState::operation_enabled, 0x6F, 0x27);
    EXPECT_EQ(drive.power(), Power::follow);
}
TEST_F(Transition, skips_no_step_on_the_way_up) {
    expect(0x0F, DriveState::switch_on_disabled, 0x4F, 0x40);
    expect(0x07, DriveState::switch_on_disabled, 0x4F, 0x40);
}
TEST_F(Transition, joins_3_and_4_when_enabled_from_ready) {
    give(0x06);
    expect(0x0F, DriveState::operation_enabled, 0x6F, 0x27);
}
TEST_F(Transition, goes_down_by_disable_operation_5_and_shutdown_6) {
    enable();
    expect(0x07, DriveState::switched_on, 0x6F, 0x23);
    expect(0x06, DriveState::ready_to_switch_on, 0x6F, 0x21);
}
TEST_F(Transition, leaves_ready_by_quick_stop_or_disable_voltage_7) {
    for (const std::uint16_t word : std::initializer_list<std::uint16_t>{0x02, 0x00}) {
        give(0x06);
        expect(word, DriveState::switch_on_disabled, 0x4F, 0x40);
    }
}
TEST_F(Transition, shuts_down_from_operation_8) {
    enable();
    expect(0x06, DriveState::ready_to_switch_on, 0x6F, 0x21);
}
TEST_F(Transition, disables_voltage_from_operation_9) {
    enable();
    expect(0x00, DriveState::switch_on_disabled, 0x4F, 0x40);
}
TEST_F(Transition, leaves_switched_on_by_quick_stop_or_disable_voltage_10) {
    for (const std::uint16_t word : std::initializer_list<std::uint16_t>{0x02, 0x00}) {
        give(0x06);
        give(0x07);
        expect(word, DriveState::switch_on_disabled, 0x4F, 0x40);
    }
}
TEST_F(Transition, stops_quickly_11_and_is_disabled_at_standstill_12) {
    enable();
    expect(0x02, DriveState::quick_stop_active, 0x6F, 0x07);
    EXPECT_EQ(drive.power(), Power::stop);
    supervise(false);
    EXPECT_EQ(drive.state(), DriveState::quick_stop_active);
    expect(0x0F, DriveState::quick_stop_active, 0x6F, 0x07); // no way back up: option code 2
    supervise(true);
    EXPECT_EQ(drive.state(), DriveState::switch_on_disabled);
}
TEST_F(Transition, may_be_disabled_during_a_quick_stop_12) {
    enable();
    give(0x02);
    expect(0x00, DriveState::switch_on_disabled, 0x4F, 0x40);
}
TEST_F(Transition, reacts_to_a_fault_13_and_rests_in_it_14) {
    enable();
    static_cast<void>(sent());
    drive.trip(wires::emergency_code::over_current, now, out);
    EXPECT_EQ(drive.statusword() & 0x4F, 0x0F);
    EXPECT_EQ(drive.power(), Power::stop);
    const auto frames = sent();
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_EQ(frames[0].id, 0x081U);
    EXPECT_EQ(frames[0].length, 8U);
    EXPECT_EQ(field_of(frames[0], 0, 2), wires::emergency_code::over_current);
    EXPECT_EQ(frames[0].data[2], 0x01);
    supervise(true);
    EXPECT_EQ(drive.statusword() & 0x4F, 0x08);
    EXPECT_EQ(drive.power(), Power::off);
}
TEST_F(Transition, resets_a_fault_on_the_rising_edge_of_bit_7_only_15) {
    give(0x80); // the bit is already high when the fault comes
    drive.trip(wires::emergency_code::over_current, now, out);
    supervise(true);
    expect(0x80, DriveState::fault, 0x4F, 0x08);
    expect(0x0F, DriveState::fault, 0x4F, 0x08);
    static_cast<void>(sent());
    expect(0x80, DriveState::switch_on_disabled, 0x4F, 0x40);
    const auto frames = sent();
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_EQ(field_of(frames[0], 0, 2), wires::emergency_code::error_reset);
}
TEST_F(Transition, is_not_reset_before_the_reaction_has_ended) {
    enable();
    drive.trip(wires::emergency_code::over_current, now, out);
    supervise(false);
    expect(0x80, DriveState::fault_reaction_active, 0x4F, 0x0F);
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
    EXPECT_EQ(field_of(frames[0], 0, 2), wires::emergency_code::command_lost);
    EXPECT_EQ(frames[0].data[2], 0x11);
}
TEST_F(SilentMachine, does_not_trip_a_drive_that_is_not_switched_on) {
    give(0x06);
    now += 1s;
    supervise(true);
    EXPECT_EQ(drive.state(), DriveState::ready_to_switch_on);
}

using BadFrames = TestDrive;

TEST_F(BadFrames, too_short_are_answered_by_an_emergency_message_and_change_nothing) {
    give(0x06);
    static_cast<void>(sent());
    drive.command(FrameWriter(wires::cob::main_drive_command).u16(0x07).frame(), now, out);
    EXPECT_EQ(drive.state(), DriveState::ready_to_switch_on);
    const auto frames = sent();
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_EQ(field_of(frames[0], 0, 2), wires::emergency_code::wrong_length);
}
TEST_F(BadFrames, are_not_heard_outside_the_operational_state) {
    static_cast<void>(drive.node().network_management(wires::nmt_command::pre_operational, 0, now));
    EXPECT_EQ(give(0x06), DriveState::switch_on_disabled);
}

} // namespace
} // namespace tappet::loom
