// The CiA 402 automaton of simulated drives, transition by transition; numbers are the standard's.
#include "drivers/canopen/simulated_drive.hpp"
#include "tests/drivers/components/drive_states.hpp"

#include <gtest/gtest.h>

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
    /// By the shortest path.
    void lead_to(DriveState state) {
        for (const std::uint16_t word : std::array<std::uint16_t, 4>{0x06, 0x07, 0x0F, 0x02})
            if (drive.state() != state) give(word);
        ASSERT_EQ(drive.state(), state);
    }
    void enable() { lead_to(DriveState::operation_enabled); }
    void expect(std::uint16_t word, DriveState state) {
        EXPECT_EQ(give(word), state) << std::hex << word;
        EXPECT_EQ(drive.statusword() & mask_of(state), statusword(state)) << std::hex << drive.statusword();
    }
    SimulatedDrive drive;
};

TEST_F(Transition, enables_the_drive_step_by_step_2_3_4) {
    EXPECT_EQ(drive.statusword() & 0x4F, 0x40);
    expect(0x06, DriveState::ready_to_switch_on);
    EXPECT_EQ(drive.power(), SimulatedDrive::Power::off);
    expect(0x07, DriveState::switched_on);
    EXPECT_EQ(drive.power(), SimulatedDrive::Power::off);
    expect(0x0F, DriveState::operation_enabled);
    EXPECT_EQ(drive.power(), SimulatedDrive::Power::follow);
}

TEST_F(Transition, follows_its_control_word) {
    using enum DriveState;
    constexpr struct {
        const char* what;
        DriveState from;
        std::uint16_t word;
        DriveState to;
    } rows[] = {{"skips no step on the way up", switch_on_disabled, 0x0F, switch_on_disabled},
                {"skips no step on the way up", switch_on_disabled, 0x07, switch_on_disabled},
                {"joins 3 and 4 when enabled from ready", ready_to_switch_on, 0x0F, operation_enabled},
                {"5: disable operation", operation_enabled, 0x07, switched_on},
                {"6: shutdown", switched_on, 0x06, ready_to_switch_on},
                {"7: quick stop", ready_to_switch_on, 0x02, switch_on_disabled},
                {"7: disable voltage", ready_to_switch_on, 0x00, switch_on_disabled},
                {"8: shutdown", operation_enabled, 0x06, ready_to_switch_on},
                {"9: disable voltage", operation_enabled, 0x00, switch_on_disabled},
                {"10: quick stop", switched_on, 0x02, switch_on_disabled},
                {"10: disable voltage", switched_on, 0x00, switch_on_disabled},
                {"12: disabled during a quick stop", quick_stop_active, 0x00, switch_on_disabled}};
    for (const auto& each : rows) {
        SCOPED_TRACE(each.what);
        drive = {};
        drive.settle(true);
        lead_to(each.from);
        expect(each.word, each.to);
    }
}

TEST_F(Transition, quick_stops_11_and_disables_at_standstill_12) {
    enable();
    expect(0x02, DriveState::quick_stop_active);
    EXPECT_EQ(drive.power(), SimulatedDrive::Power::stop);
    drive.settle(false);
    EXPECT_EQ(drive.state(), DriveState::quick_stop_active);
    expect(0x0F, DriveState::quick_stop_active); // no way back up: option code 2
    drive.settle(true);
    EXPECT_EQ(drive.state(), DriveState::switch_on_disabled);
}
TEST_F(Transition, enters_a_fault_13_14_and_leaves_it_by_an_edge_15) {
    enable();
    EXPECT_TRUE(drive.trip());
    EXPECT_FALSE(drive.trip());
    EXPECT_EQ(drive.power(), SimulatedDrive::Power::stop);
    expect(0x80, DriveState::fault_reaction_active); // too early
    drive.settle(false);
    EXPECT_EQ(drive.state(), DriveState::fault_reaction_active);
    drive.settle(true);
    expect(0x80, DriveState::fault);
    expect(0x00, DriveState::fault);
    expect(0x80, DriveState::switch_on_disabled);
}

TEST(SimulatedDrive, follows_its_control_and_stops_after_a_trip) {
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
