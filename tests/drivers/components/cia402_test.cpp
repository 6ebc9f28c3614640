// The controller's side of CiA 402 against a model of the drive's automaton.
#include "tests/drivers/components/drive_states.hpp"

#include <gtest/gtest.h>

namespace tappet::canopen {
namespace {

/// The drive's automaton, CiA 402-2 figure 8; a quick stop ends in "switch on disabled" after a while.
struct Drive {
    DriveState state = DriveState::not_ready;
    bool cause_persists = false;
    int resets = 0;
    std::uint16_t last = 0;

    void take(std::uint16_t word) {
        const bool rising = (word & 0x80) != 0 && (last & 0x80) == 0;
        last = word;
        if (state == DriveState::not_ready)
            state = DriveState::switch_on_disabled;
        else if (state == DriveState::fault_reaction_active)
            state = DriveState::fault;
        else if (state == DriveState::fault) {
            if (!rising) return;
            ++resets;
            if (!cause_persists) state = DriveState::switch_on_disabled;
        } else if ((word & 0x02) == 0)
            state = DriveState::switch_on_disabled;
        else if ((word & 0x04) == 0)
            state = state == DriveState::operation_enabled || state == DriveState::quick_stop_active
                        ? DriveState::quick_stop_active
                        : DriveState::switch_on_disabled;
        else if (state == DriveState::switch_on_disabled)
            state = (word & 0x07) == 0x06 ? DriveState::ready_to_switch_on : state;
        else if (state == DriveState::ready_to_switch_on)
            state = (word & 0x07) == 0x07 ? DriveState::switched_on : state;
        else if (state == DriveState::switched_on && (word & 0x0F) == 0x0F)
            state = DriveState::operation_enabled;
    }
};

void run(DriveControl& control, Drive& drive, int cycles) {
    for (int i = 0; i < cycles; ++i) drive.take(control.controlword(statusword(drive.state, 0xFFFF)));
}

TEST(Cia402, decodes_every_state_whatever_the_other_statusword_bits) {
    for (const DriveState state : every_state)
        for (const std::uint16_t noise :
             {std::uint16_t{0}, std::uint16_t{0xFFFF}, std::uint16_t{0x1230}, std::uint16_t{0x0290}})
            EXPECT_EQ(drive_state(statusword(state, noise)), state);
}

TEST(Cia402, leads_every_state_to_its_goal) {
    for (const DriveState state : every_state) {
        const bool moved = state == DriveState::operation_enabled || state == DriveState::quick_stop_active;
        const bool broken = state == DriveState::fault || state == DriveState::fault_reaction_active;
        const struct {
            const char* what;
            DriveGoal goal;
            bool acknowledges;
            DriveState ends_in;
        } cases[] = {{"enabled", DriveGoal::enabled, true, DriveState::operation_enabled},
                     {"off", DriveGoal::off, true, DriveState::switch_on_disabled},
                     {"stops a running drive quickly and powers no other one", DriveGoal::quick_stop, false,
                      moved    ? DriveState::quick_stop_active
                      : broken ? DriveState::fault
                               : DriveState::switch_on_disabled}};
        for (const auto& each : cases) {
            DriveControl control;
            Drive drive{state};
            control.want(each.goal);
            if (each.acknowledges) control.acknowledge();
            run(control, drive, 6);
            EXPECT_EQ(drive.state, each.ends_in) << each.what << ", from " << static_cast<int>(state);
        }
    }
}

TEST(Cia402, resets_a_fault_only_after_it_is_acknowledged) {
    DriveControl control;
    Drive drive{DriveState::fault};
    control.want(DriveGoal::enabled);
    run(control, drive, 1000);
    EXPECT_EQ(drive.state, DriveState::fault);
    EXPECT_EQ(drive.resets, 0);
    control.acknowledge();
    run(control, drive, 6);
    EXPECT_EQ(drive.state, DriveState::operation_enabled);
    EXPECT_EQ(drive.resets, 1);
}

TEST(Cia402, does_not_keep_an_acknowledgement_for_a_later_fault) {
    DriveControl control;
    Drive drive;
    control.want(DriveGoal::enabled);
    control.acknowledge(); // there is no fault
    run(control, drive, 10);
    drive.state = DriveState::fault_reaction_active;
    run(control, drive, 100);
    EXPECT_EQ(drive.state, DriveState::fault);
    EXPECT_EQ(drive.resets, 0);
}

TEST(Cia402, accepts_an_acknowledgement_during_the_fault_reaction) {
    DriveControl control;
    control.want(DriveGoal::enabled);
    control.acknowledge();
    EXPECT_EQ(control.controlword(statusword(DriveState::fault_reaction_active)) & 0x80, 0);
    EXPECT_EQ(control.controlword(statusword(DriveState::fault)) & 0x80, 0x80);
}

TEST(Cia402, holds_the_reset_bit_high_against_lost_frames) {
    DriveControl control;
    control.acknowledge();
    for (int i = 0; i < 10; ++i)
        EXPECT_EQ(control.controlword(statusword(DriveState::fault)), controlword::fault_reset);
}

TEST(Cia402, raises_a_new_edge_for_each_acknowledgement_of_a_lasting_fault) {
    DriveControl control;
    Drive drive{DriveState::fault, true};
    control.want(DriveGoal::enabled);
    for (int i = 1; i <= 3; ++i) {
        control.acknowledge();
        run(control, drive, 100);
        EXPECT_EQ(drive.resets, i);
    }
    drive.cause_persists = false;
    run(control, drive, 100);
    EXPECT_EQ(drive.state, DriveState::fault) << "nobody acknowledged since";
    control.acknowledge();
    run(control, drive, 100);
    EXPECT_EQ(drive.state, DriveState::operation_enabled);
}

TEST(Cia402, holds_the_reset_bit_low_long_enough_for_the_bus) {
    DriveControl control;
    control.acknowledge();
    static_cast<void>(control.controlword(statusword(DriveState::fault)));
    control.acknowledge();
    int down = 0;
    while (control.controlword(statusword(DriveState::fault)) == controlword::disable_voltage && down < 1000)
        ++down;
    EXPECT_EQ(down, DriveControl::low_cycles);
}

TEST(Cia402, resets_once_per_acknowledgement_though_the_drive_faults_again) {
    DriveControl control;
    Drive drive{DriveState::fault};
    control.want(DriveGoal::enabled);
    control.acknowledge();
    run(control, drive, 1);
    drive.state = DriveState::fault_reaction_active; // before any other state was seen
    run(control, drive, 100);
    EXPECT_EQ(drive.state, DriveState::fault);
    EXPECT_EQ(drive.resets, 1);
}

} // namespace
} // namespace tappet::canopen
