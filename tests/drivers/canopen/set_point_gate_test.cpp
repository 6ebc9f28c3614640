// Words and set points that a drive receives, and when: drives with and without a halt bit in cyclic modes,
// with quick and slow mode changes, behind frames that take up to fifty cycles there and back.
#include "tests/drivers/canopen/watched_drive.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace tappet::canopen {
namespace {

using motion::AxisMode;
using enum OperationMode;

/// Runs `check` for each drive: with and without a halt bit in cyclic modes, quick and slow, near and far.
template <class Check> void on_each_drive(Check check) {
    for (const bool knows_halt : {true, false})
        for (const int mode_steps : {0, 30})
            for (const auto& [there, back] : {std::pair{0, 0}, {2, 2}, {0, 25}, {25, 0}, {25, 25}}) {
                SCOPED_TRACE(testing::Message()
                             << (knows_halt ? "knows" : "knows no") << " halt, mode after " << mode_steps
                             << ", " << there << " there, " << back << " back");
                Watched rig;
                rig.is(there, back, knows_halt, mode_steps);
                check(rig);
                if (testing::Test::HasFailure()) return;
            }
}

/// Positions at `speed`, from the current one.
void follow_positions(Watched& rig, double speed, int count) {
    ASSERT_TRUE(rig.axis.synchronize(cyclic_position));
    ASSERT_TRUE(rig.watched_until([&] { return rig.axis.follows(); }));
    rig.ask(std::abs(speed));
    double place = rig.last.position;
    for (int i = 0; i < count; ++i) {
        rig.axis.follow(place += speed * DriveRig::dt);
        rig.watched_cycle();
    }
}

/// Starts a motion in that mode and watches it from its beginning.
void begin(Watched& rig, OperationMode mode, double speed) {
    if (mode == cyclic_position) return follow_positions(rig, speed, 200);
    if (mode == profile_position)
        ASSERT_TRUE(rig.axis.move_to(500, speed));
    else if (mode == profile_velocity)
        ASSERT_TRUE(rig.axis.move_at(speed));
    else {
        ASSERT_TRUE(rig.axis.synchronize(mode));
        rig.axis.follow(mode == cyclic_velocity ? speed : 1);
    }
    rig.ask(mode == cyclic_torque ? 100 : speed);
}
constexpr std::array modes{profile_position, profile_velocity, cyclic_position, cyclic_velocity,
                           cyclic_torque};

TEST(SetPointGate, keeps_an_axis_that_was_turned_by_hand_in_place) {
    for (const OperationMode mode : modes)
        on_each_drive([&](Watched& rig) {
            SCOPED_TRACE(testing::Message() << "mode " << static_cast<int>(mode));
            ASSERT_TRUE(rig.gets_power());
            begin(rig, mode, 20);
            rig.watched_run(400);
            EXPECT_NE(rig.servo.position(), 0);
            rig.axis.power(false);
            rig.ask_rest();
            ASSERT_TRUE(rig.watched_until([&] { return rig.servo.turn(0); }));
            rig.watched_run(10);
            EXPECT_TRUE(rig.servo.turn(5.45));
            rig.watched_run(200);
            const double there = rig.servo.position();
            ASSERT_TRUE(rig.gets_power());
            rig.watched_run(1000);
            EXPECT_EQ(rig.axis.state(), AxisMode::standstill);
            EXPECT_EQ(rig.servo.position(), there);
        });
}

TEST(SetPointGate, enables_no_power_while_the_drive_shows_cyclic_position) {
    on_each_drive([](Watched& rig) {
        rig.is(static_cast<int>(rig.cycles_out), static_cast<int>(rig.cycles_in), false, 0, cyclic_position);
        rig.servo.faults.refuses_mode = true;
        rig.axis.power(true);
        for (int i = 0; i < 1000; ++i) { // turned by hand until the last moment
            rig.servo.turn(0.01);
            rig.watched_cycle();
        }
        EXPECT_EQ(rig.servo.state(), DriveState::switched_on);
        EXPECT_TRUE(rig.comes_to(AxisMode::error_stop)) << "somebody learns of it";
        rig.servo.faults.refuses_mode = false;
        rig.axis.reset();
        EXPECT_TRUE(rig.comes_to(AxisMode::standstill));
    });
}

TEST(SetPointGate, enables_no_power_while_a_disabling_word_is_in_flight) {
    for (int when = 0; when < 120; ++when) {
        SCOPED_TRACE(testing::Message() << "power is lost after " << when << " cycles");
        Watched rig;
        rig.is(7, 24, false, 0);
        rig.axis.power(true);
        for (int i = 0; i < 300; ++i) {
            if (i == when) rig.servo.lose_power();
            rig.servo.turn(0.02);
            if (rig.axis.state() == AxisMode::standstill)
                static_cast<void>(rig.axis.synchronize(cyclic_position));
            rig.watched_cycle();
        }
        if (HasFailure()) return;
    }
}

TEST(SetPointGate, sends_a_target_position_only_in_profile_position) {
    on_each_drive([](Watched& rig) {
        ASSERT_TRUE(rig.gets_power());
        follow_positions(rig, 20, 200);
        ASSERT_TRUE(rig.move_to(50, 5));
        while (rig.servo.mode() == 8) {
            rig.watched_cycle();
            EXPECT_LT(rig.last.position, 5);
        }
        rig.watched_run(1000);
        EXPECT_NEAR(rig.servo.velocity(), 5, 1e-9);
        ASSERT_TRUE(rig.move_to(10, 50));
        EXPECT_TRUE(rig.comes_to(AxisMode::standstill));
        EXPECT_NEAR(rig.servo.position(), 10, 1e-9);
    });
}

TEST(SetPointGate, hands_over_between_all_modes) {
    for (const OperationMode from : modes)
        for (const OperationMode to : modes)
            on_each_drive([&](Watched& rig) {
                SCOPED_TRACE(testing::Message() << static_cast<int>(from) << " to " << static_cast<int>(to));
                ASSERT_TRUE(rig.gets_power());
                double speed = 30;
                for (const OperationMode mode : {from, to}) {
                    begin(rig, mode, speed);
                    rig.watched_run(mode == cyclic_position ? 0 : 600);
                    if (mode != cyclic_torque) {
                        EXPECT_NEAR(rig.servo.velocity(), speed, 1e-6);
                    }
                    EXPECT_EQ(rig.servo.mode(), static_cast<std::int64_t>(mode));
                    speed = 10;
                }
                ASSERT_TRUE(rig.axis.halt());
                rig.ask_rest();
                EXPECT_TRUE(rig.comes_to(AxisMode::standstill));
                EXPECT_EQ(rig.servo.velocity(), 0);
                const double there = rig.servo.position();
                rig.watched_run(200);
                EXPECT_EQ(rig.servo.position(), there);
            });
}

TEST(SetPointGate, does_not_confuse_a_homing_with_the_previous_one) {
    on_each_drive([](Watched& rig) {
        rig.servo.faults.remembers_home = true;
        rig.servo.set_home(7);
        ASSERT_TRUE(rig.gets_power());
        for (int count = 1; count <= 2; ++count) {
            ASSERT_TRUE(rig.go_home());
            EXPECT_TRUE(rig.watched_until([&] { return rig.axis.state() != AxisMode::homing; }));
            EXPECT_EQ(rig.axis.state(), AxisMode::standstill);
            EXPECT_EQ(rig.servo.homings(), count);
            EXPECT_NEAR(rig.servo.position(), 0, 1e-9);
            ASSERT_TRUE(rig.move_to(9, 50));
            EXPECT_TRUE(rig.comes_to(AxisMode::standstill));
        }
    });
}

TEST(SetPointGate, completes_only_a_homing_that_the_drive_has_begun) {
    on_each_drive([](Watched& rig) {
        rig.servo.faults.remembers_home = true;
        ASSERT_TRUE(rig.gets_power());
        ASSERT_TRUE(rig.go_home());
        ASSERT_TRUE(rig.comes_to(AxisMode::standstill));
        ASSERT_TRUE(rig.move_to(5, 50));
        ASSERT_TRUE(rig.comes_to(AxisMode::standstill));
        rig.servo.faults.ignores_homing = true;
        ASSERT_TRUE(rig.go_home());
        rig.watched_run(1000);
        EXPECT_EQ(rig.axis.state(), AxisMode::homing);
        EXPECT_TRUE(rig.comes_to(AxisMode::error_stop));
        EXPECT_EQ(rig.servo.homings(), 1);
    });
}

TEST(SetPointGate, adds_a_superimposed_motion_to_the_current_one) {
    on_each_drive([](Watched& rig) {
        ASSERT_TRUE(rig.gets_power());
        ASSERT_TRUE(rig.axis.superimpose(2, 50, 500)) << "at a stand: a relative motion";
        EXPECT_EQ(rig.axis.state(), AxisMode::discrete_motion);
        rig.ask(50);
        EXPECT_FALSE(rig.axis.superimpose(2, 50, 500)) << "the drive makes it, and adds nothing";
        EXPECT_EQ(rig.axis.state(), AxisMode::discrete_motion);
        ASSERT_TRUE(rig.comes_to(AxisMode::standstill));
        EXPECT_NEAR(rig.servo.position(), 2, 1e-9);
        follow_positions(rig, 20, 100);
        ASSERT_TRUE(rig.axis.superimpose(3, 10, 500));
        EXPECT_EQ(rig.axis.state(), AxisMode::synchronized_motion);
        EXPECT_TRUE(rig.axis.superimposes());
        rig.ask(30);
        double place = 4;
        for (int i = 0; i < 500; ++i) {
            rig.axis.follow(place += 0.02);
            rig.watched_cycle();
        }
        EXPECT_EQ(rig.axis.state(), AxisMode::synchronized_motion);
        EXPECT_FALSE(rig.axis.superimposes());
        rig.watched_run(rig.round_trip());
        EXPECT_NEAR(rig.servo.position(), 4 + 10 + 3, 1e-9);
        EXPECT_FALSE(rig.axis.superimpose(std::nan(""), 10, 500));
        EXPECT_FALSE(rig.axis.superimpose(1, 0, 500));
        EXPECT_FALSE(rig.axis.synchronize(OperationMode::cyclic_position))
            << "whether new positions have the distance in them nobody knows";
        for (int i = 0; i < 100; ++i) {
            rig.axis.follow(place += 0.02);
            rig.watched_cycle();
        }
        rig.watched_run(rig.round_trip());
        EXPECT_NEAR(rig.servo.position(), 4 + 12 + 3, 1e-9) << "what runs goes on";
        ASSERT_TRUE(rig.axis.halt());
        EXPECT_FALSE(rig.axis.superimpose(1, 10, 500)) << "nothing runs that it could be added to";
    });
}

TEST(SetPointGate, passes_only_finite_set_points) {
    on_each_drive([](Watched& rig) {
        ASSERT_TRUE(rig.gets_power());
        for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
            EXPECT_FALSE(rig.axis.move_at(bad));
            EXPECT_FALSE(rig.axis.move_to(bad, 1));
            EXPECT_FALSE(rig.axis.move_to(1, bad));
        }
        EXPECT_FALSE(rig.axis.move_to(1, 0));
        EXPECT_FALSE(rig.axis.move_to(1, -5));
        EXPECT_EQ(rig.axis.state(), AxisMode::standstill);
        follow_positions(rig, 20, 100);
        const double place = rig.last.position;
        for (const double bad : {std::nan(""), HUGE_VAL}) rig.axis.follow(bad), rig.watched_cycle();
        EXPECT_EQ(rig.last.position, place);
        rig.says_nonsense = true;
        rig.watched_cycle();
        EXPECT_EQ(rig.axis.state(), AxisMode::error_stop) << "a place that is none is not heard";
        EXPECT_EQ(rig.last.position, place);
    });
}

TEST(SetPointGate, enables_no_power_after_an_error_stop) {
    on_each_drive([](Watched& rig) {
        ASSERT_TRUE(rig.gets_power());
        ASSERT_TRUE(rig.move_to(500, 20));
        rig.watched_run(300);
        rig.servo.lose_power();
        ASSERT_TRUE(rig.comes_to(AxisMode::error_stop));
        rig.axis.power(true); // again, without a reset
        rig.watched_run(500);
        EXPECT_NE(rig.servo.state(), DriveState::operation_enabled);
        EXPECT_EQ(rig.axis.state(), AxisMode::error_stop);
    });
}

} // namespace
} // namespace tappet::canopen
