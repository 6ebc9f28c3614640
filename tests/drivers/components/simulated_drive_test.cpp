// The CiA 402 automaton of simulated drives, transition by transition; numbers are the standard's.
#include "drivers/canopen/simulated_drive.hpp"

#include <gtest/gtest.h>

#include <initializer_list>

namespace tappet::canopen {
namespace {

struct Transition : testing::Test {
    Transition() {
        EXPECT_EQ(drive.state(), DriveState::not_ready);
        drive.settle(true); // 1
    }
    DriveState give(std::uint16_t word) {
        drive.control(word);
        return drive.state();
    }
    void enable() {
        give(0x06);
        give(0x07);
        ASSERT_EQ(give(0x0F), DriveState::operation_enabled);
    }
    void expect(std::uint16_t word, DriveState state, unsigned mask, unsigned status) {
        EXPECT_EQ(give(word), state) << std::hex << word;
        EXPECT_EQ(drive.statusword() & mask, status) << std::hex << drive.statusword();
    }
    SimulatedDrive drive;
};

TEST_F(Transition, goes_up_step_by_step_2_3_4) {
    EXPECT_EQ(drive.statusword() & 0x4F, 0x40);
    expect(0x06, DriveState::ready_to_switch_on, 0x6F, 0x21);
    EXPECT_EQ(drive.power(), SimulatedDrive::Power::off);
    expect(0x07, DriveState::switched_on, 0x6F, 0x23);
    EXPECT_EQ(drive.power(), SimulatedDrive::Power::off);
    expect(0x0F, DriveState::operation_enabled, 0x6F, 0x27);
    EXPECT_EQ(drive.power(), SimulatedDrive::Power::follow);
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
    EXPECT_EQ(drive.power(), SimulatedDrive::Power::stop);
    drive.settle(false);
    EXPECT_EQ(drive.state(), DriveState::quick_stop_active);
    expect(0x0F, DriveState::quick_stop_active, 0x6F, 0x07); // no way back up: option code 2
    drive.settle(true);
    EXPECT_EQ(drive.state(), DriveState::switch_on_disabled);
}
TEST_F(Transition, may_be_disabled_during_a_quick_stop_12) {
    enable();
    give(0x02);
    expect(0x00, DriveState::switch_on_disabled, 0x4F, 0x40);
}
TEST_F(Transition, reacts_to_a_fault_once_13_rests_in_it_14_and_is_reset_by_a_rising_edge_15) {
    enable();
    EXPECT_TRUE(drive.trip());
    EXPECT_FALSE(drive.trip());
    EXPECT_EQ(drive.power(), SimulatedDrive::Power::stop);
    expect(0x80, DriveState::fault_reaction_active, 0x4F, 0x0F); // too early
    drive.settle(false);
    EXPECT_EQ(drive.state(), DriveState::fault_reaction_active);
    drive.settle(true);
    expect(0x80, DriveState::fault, 0x4F, 0x08);
    expect(0x00, DriveState::fault, 0x4F, 0x08);
    expect(0x80, DriveState::switch_on_disabled, 0x4F, 0x40);
}

TEST(SimulatedDrive, of_a_plant_that_needs_no_more_is_led_by_a_control_and_lost_by_a_fault) {
    SimulatedDrive drive;
    DriveControl control;
    control.want(DriveGoal::enabled);
    std::uint16_t status = 0;
    for (int i = 0; i < 5; ++i) status = drive.follow(control.controlword(status));
    EXPECT_TRUE(drive.is_enabled());
    control.want(DriveGoal::quick_stop);
    status = drive.follow(control.controlword(status));
    EXPECT_EQ(drive_state(status), DriveState::switch_on_disabled);
    control.want(DriveGoal::enabled);
    drive.trip();
    for (int i = 0; i < 5; ++i) status = drive.follow(control.controlword(status));
    EXPECT_EQ(drive_state(status), DriveState::fault);
    control.acknowledge();
    for (int i = 0; i < 5; ++i) status = drive.follow(control.controlword(status));
    EXPECT_TRUE(drive.is_enabled());
}

} // namespace
} // namespace tappet::canopen
