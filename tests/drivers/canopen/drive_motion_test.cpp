// A drive as an axis, in every mode, against a simulated one whose frames take two cycles each way.
#include "tests/drivers/canopen/drive_rig.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace tappet::canopen {
namespace {

using motion::AxisMode;

struct Axis : testing::Test, DriveRig {
    void SetUp() override { power(); }
    void power() { ASSERT_TRUE(gets_power()); }
};
struct AxisWithoutPower : Axis {
    void SetUp() override {}
};

TEST_F(AxisWithoutPower, is_powered_only_once_the_drive_confirms_it) {
    axis.power(true);
    run(2);
    EXPECT_EQ(axis.state(), AxisMode::disabled);
    EXPECT_FALSE(axis.move_to(1, 10)) << "without power";
    EXPECT_TRUE(reaches(AxisMode::standstill));
    EXPECT_EQ(servo.state(), DriveState::operation_enabled);
    axis.power(false);
    EXPECT_EQ(axis.state(), AxisMode::disabled);
    EXPECT_TRUE(until([&] { return servo.state() == DriveState::switch_on_disabled; }));
}

TEST_F(Axis, moves_to_a_position_by_the_profile_position_handshake) {
    ASSERT_TRUE(axis.move_to(25, 50));
    EXPECT_EQ(axis.state(), AxisMode::discrete_motion);
    const int from = cycles;
    EXPECT_TRUE(reaches(AxisMode::standstill));
    EXPECT_NEAR(servo.position(), 25, 1e-9);
    EXPECT_EQ(servo.set_points(), 1);
    EXPECT_GT(cycles - from, 500) << "at 50 a second";
    // "Target reached" of the previous motion is still set when this one begins.
    ASSERT_TRUE(axis.move_to(0, 50));
    run(3);
    EXPECT_EQ(axis.state(), AxisMode::discrete_motion);
    EXPECT_TRUE(reaches(AxisMode::standstill));
    EXPECT_NEAR(servo.position(), 0, 1e-9);
    EXPECT_EQ(servo.set_points(), 2);
}

TEST_F(Axis, accepts_a_new_position_while_it_moves) {
    ASSERT_TRUE(axis.move_to(50, 50));
    run(200);
    ASSERT_TRUE(axis.move_to(-10, 50));
    EXPECT_TRUE(reaches(AxisMode::standstill));
    EXPECT_NEAR(servo.position(), -10, 1e-9);
    EXPECT_EQ(servo.set_points(), 2);
}

TEST_F(Axis, raises_the_set_point_bit_only_after_the_last_acknowledgement_cleared) {
    servo.faults.keeps_acknowledgement = true;
    ASSERT_TRUE(axis.move_to(5, 50));
    run(500);
    EXPECT_EQ(axis.state(), AxisMode::discrete_motion)
        << "the drive stands there, and the handshake is not over";
    EXPECT_EQ(last.controlword & 0x10u, 0u);
    ASSERT_TRUE(axis.move_to(9, 50));
    run(500);
    EXPECT_EQ(servo.set_points(), 1);
    EXPECT_EQ(last.controlword & 0x10u, 0u);
    servo.faults.keeps_acknowledgement = false;
    EXPECT_TRUE(reaches(AxisMode::standstill));
    EXPECT_NEAR(servo.position(), 9, 1e-9);
}

TEST_F(Axis, does_not_complete_a_motion_that_the_drive_ignores) {
    servo.faults.ignores_set_points = true;
    ASSERT_TRUE(axis.move_to(5, 50));
    run(2000);
    EXPECT_EQ(axis.state(), AxisMode::discrete_motion);
    EXPECT_NE(last.controlword & 0x10u, 0u) << "it keeps asking";
}

TEST_F(Axis, drops_an_old_target_position_after_a_halt) {
    ASSERT_TRUE(axis.move_to(50, 50));
    run(300);
    ASSERT_TRUE(axis.halt());
    EXPECT_TRUE(reaches(AxisMode::standstill));
    const double there = servo.position();
    EXPECT_LT(there, 40);
    run(1000);
    EXPECT_EQ(servo.position(), there);
    ASSERT_TRUE(axis.move_to(there + 1, 50));
    EXPECT_TRUE(reaches(AxisMode::standstill));
    EXPECT_NEAR(servo.position(), there + 1, 1e-9);
}

TEST_F(Axis, moves_at_a_velocity_until_it_is_halted) {
    ASSERT_TRUE(axis.move_at(-30));
    EXPECT_EQ(axis.state(), AxisMode::continuous_motion);
    EXPECT_TRUE(until([&] { return servo.velocity() == -30; }));
    run(500);
    EXPECT_EQ(axis.state(), AxisMode::continuous_motion);
    ASSERT_TRUE(axis.halt());
    EXPECT_TRUE(reaches(AxisMode::standstill));
    EXPECT_EQ(servo.velocity(), 0);
}

TEST_F(Axis, refuses_motions_while_it_is_stopped) {
    ASSERT_TRUE(axis.move_at(30));
    run(200);
    ASSERT_TRUE(axis.stop());
    run(500);
    EXPECT_EQ(axis.state(), AxisMode::stopping) << "until the stop is let go";
    EXPECT_EQ(servo.velocity(), 0);
    EXPECT_FALSE(axis.move_at(30));
    axis.release();
    EXPECT_TRUE(reaches(AxisMode::standstill));
    EXPECT_TRUE(axis.move_at(30));
}

TEST_F(AxisWithoutPower, enters_error_stop_when_homing_fails) {
    servo.faults.fails_homing = true;
    power();
    ASSERT_TRUE(axis.home());
    EXPECT_TRUE(reaches(AxisMode::error_stop));
    EXPECT_TRUE(until([&] { return servo.state() != DriveState::operation_enabled; })) << "a quick stop";
    axis.reset();
    EXPECT_TRUE(reaches(AxisMode::standstill));
}

TEST_F(Axis, follows_positions_velocities_and_torques_cycle_by_cycle) {
    EXPECT_FALSE(axis.synchronize(OperationMode::profile_position));
    ASSERT_TRUE(axis.synchronize(OperationMode::cyclic_position));
    ASSERT_TRUE(until([&] { return axis.follows(); }));
    EXPECT_EQ(servo.position(), 0) << "no jump";
    for (int i = 0; i < 1000; ++i) {
        axis.follow(0.02 * i);
        cycle();
    }
    EXPECT_NEAR(servo.position(), 20, 0.2);
    axis.follow(std::nan(""));
    run(50);
    EXPECT_NEAR(servo.position(), 0.02 * 999, 1e-9) << "what is no number is no set point";
    ASSERT_TRUE(axis.synchronize(OperationMode::cyclic_velocity));
    axis.follow(12);
    EXPECT_TRUE(until([&] { return servo.velocity() == 12; }));
    ASSERT_TRUE(axis.synchronize(OperationMode::cyclic_torque));
    axis.follow(-4);
    run(1000);
    EXPECT_NEAR(servo.velocity(), 8, 0.1);
    ASSERT_TRUE(axis.halt());
    EXPECT_TRUE(reaches(AxisMode::standstill));
    EXPECT_EQ(servo.velocity(), 0);
    EXPECT_FALSE(axis.follows());
}

TEST_F(AxisWithoutPower, reaches_standstill_at_rest_even_with_a_zero_velocity_limit) {
    axis.set_standing(0);
    power();
    ASSERT_TRUE(axis.move_at(5));
    run(300);
    ASSERT_TRUE(axis.halt());
    EXPECT_TRUE(reaches(AxisMode::standstill));
}

TEST_F(Axis, refuses_an_invalid_superimposed_motion_at_standstill_too) {
    for (const auto& [distance, velocity, acceleration] : {std::array{10.0, 20.0, std::nan("")},
                                                           {10.0, 20.0, -5.0},
                                                           {10.0, -1.0, 5.0},
                                                           {std::nan(""), 20.0, 5.0}})
        EXPECT_FALSE(axis.superimpose(distance, velocity, acceleration))
            << distance << velocity << acceleration;
    run(100);
    EXPECT_EQ(axis.state(), AxisMode::standstill);
    EXPECT_EQ(servo.position(), 0);
}

TEST_F(Axis, waits_until_the_drive_shows_its_mode) {
    servo.faults.refuses_mode = true;
    ASSERT_TRUE(axis.move_at(30));
    run(1000);
    EXPECT_EQ(servo.velocity(), 0);
    servo.faults.refuses_mode = false;
    EXPECT_TRUE(until([&] { return servo.velocity() == 30; }));
}

TEST_F(Axis, enters_error_stop_on_a_fault_and_leaves_it_only_by_a_reset) {
    ASSERT_TRUE(axis.move_at(30));
    run(300);
    ASSERT_TRUE(servo.trip());
    EXPECT_TRUE(reaches(AxisMode::error_stop));
    run(1000);
    EXPECT_EQ(servo.state(), DriveState::fault) << "nobody reset it";
    EXPECT_FALSE(axis.move_at(30));
    axis.reset();
    EXPECT_TRUE(reaches(AxisMode::standstill));
    run(500);
    EXPECT_EQ(servo.velocity(), 0) << "the motion before is forgotten";
    EXPECT_TRUE(axis.move_at(30));
}

TEST_F(Axis, enters_error_stop_when_the_drive_disables_itself) {
    ASSERT_TRUE(axis.move_at(30));
    run(300);
    servo.stop_quickly();
    EXPECT_TRUE(reaches(AxisMode::error_stop)) << "quick stop active is no operation";
    run(500);
    EXPECT_NE(servo.state(), DriveState::operation_enabled) << "it is not enabled behind somebody's back";
    axis.reset();
    EXPECT_TRUE(reaches(AxisMode::standstill));
    servo.lose_power();
    EXPECT_TRUE(reaches(AxisMode::error_stop));
}

TEST_F(Axis, enters_error_stop_when_the_drive_is_silent) {
    ASSERT_TRUE(axis.move_at(30));
    run(100);
    heard = false;
    cycle();
    EXPECT_EQ(axis.state(), AxisMode::error_stop);
    EXPECT_EQ(last.controlword, controlword::disable_voltage);
    axis.reset();
    run(100);
    EXPECT_EQ(axis.state(), AxisMode::error_stop);
    heard = true;
    EXPECT_TRUE(reaches(AxisMode::standstill));
}

TEST_F(Axis, reports_a_following_error_and_a_limit_of_the_drive) {
    ASSERT_TRUE(axis.move_to(5, 50));
    servo.faults.is_blocked = servo.faults.is_at_limit = true;
    EXPECT_TRUE(until([&] { return axis.lags(); }));
    EXPECT_TRUE(axis.is_limited());
    servo.faults.is_blocked = servo.faults.is_at_limit = false;
    EXPECT_TRUE(reaches(AxisMode::standstill));
    EXPECT_FALSE(axis.lags());
}

/// Follows a shaft with a superimposed distance; then sends `ask` within one cycle. The leading shaft
/// continues, and restarts from the last target position only if the axis reported that it did not follow.
/// Returns the largest jump of the target position.
template <class Ask>
double jump_after(Ask ask, bool comes_to_a_stand = true) {
    DriveRig rig;
    double place = 0, jump = 0;
    bool followed = true, left_the_mode = false;
    const auto follow = [&](int cycles) {
        for (int k = 0; k < cycles; ++k) {
            if (rig.axis.follows() && !std::exchange(followed, true)) place = rig.last.position;
            if (!rig.axis.follows()) followed = false;
            rig.axis.follow(place += 0.02);
            const double was = rig.last.position;
            rig.cycle();
            jump = std::max(jump, std::abs(rig.last.position - was));
            left_the_mode |= rig.last.mode != 8;
        }
    };
    EXPECT_TRUE(rig.gets_power() && rig.axis.synchronize(OperationMode::cyclic_position));
    EXPECT_TRUE(rig.until([&] { return rig.axis.follows(); }));
    follow(100);
    EXPECT_TRUE(rig.axis.superimpose(30, 100, 5000));
    follow(1000);
    ask(rig, follow);
    follow(1000);
    EXPECT_TRUE(rig.axis.follows());
    EXPECT_EQ(left_the_mode, comes_to_a_stand);
    return jump;
}

TEST(DriveMotion, never_jumps_because_of_a_superimposed_distance) {
    const auto anew = [](DriveRig& rig) {
        return rig.axis.synchronize(OperationMode::cyclic_position).has_value();
    };
    EXPECT_LT(jump_after([&](DriveRig& rig, auto&) { EXPECT_FALSE(anew(rig)); }, false), 0.5);
    EXPECT_LT(jump_after([&](DriveRig& rig, auto&) { EXPECT_TRUE(rig.axis.halt() && anew(rig)); }), 0.5);
    EXPECT_LT(jump_after([&](DriveRig& rig, auto&) { EXPECT_TRUE(rig.axis.move_at(20) && anew(rig)); }), 0.5);
    EXPECT_LT(jump_after([&](DriveRig& rig, auto&) {
                  EXPECT_TRUE(rig.axis.synchronize(OperationMode::cyclic_velocity) && anew(rig));
              }),
              0.5);
    EXPECT_LT(jump_after([&](DriveRig& rig, auto& follow) {
                  rig.feedback[1].mode = 0; // one frame
                  follow(1);
                  static_cast<void>(anew(rig)); // refused or not
              }),
              0.5);
}

} // namespace
} // namespace tappet::canopen
