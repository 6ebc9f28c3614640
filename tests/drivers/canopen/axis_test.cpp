// The motions of an axis, as its commands and its set points request them.
#include "tests/drivers/canopen/servo_axis.hpp"

namespace tappet::test {
namespace {

struct AxisWithoutPower : ServoAxis {
    void SetUp() override {}
};

TEST_F(ServoAxis, does_not_complete_a_halted_motion) {
    ASSERT_TRUE(client->move_to.send(100.0, 20.0));
    run(1s);
    EXPECT_TRUE(does(client->halt));
    EXPECT_EQ(client->move_to.state(), CommandState::failed);
    client->move_to.reset();
    follow_positions();
    ASSERT_TRUE(client->superimpose.send(50.0, 10.0, 500.0));
    run(500ms);
    EXPECT_TRUE(does(client->halt));
    EXPECT_EQ(client->superimpose.state(), CommandState::failed);
}

TEST_F(ServoAxis, does_not_complete_a_replaced_motion) {
    ASSERT_TRUE(client->superimpose.send(5.0, 20.0, 100.0)); // from standstill, a relative move
    run(100ms);
    EXPECT_TRUE(does(client->move_to, -50.0, 80.0));
    EXPECT_EQ(client->superimpose.state(), CommandState::failed);
    client->superimpose.reset();
    follow_positions();
    ASSERT_TRUE(client->superimpose.send(50.0, 10.0, 500.0));
    run(500ms);
    client->synchronize.reset();
    ASSERT_TRUE(client->synchronize.send(9));
    ASSERT_TRUE(until([&] { return !in_flight(client->superimpose.state()); }));
    EXPECT_EQ(client->superimpose.state(), CommandState::failed);
}

TEST_F(ServoAxis, stays_stopped_until_it_is_released_even_across_a_power_cycle) {
    EXPECT_TRUE(does(client->come_to_stop));
    client->power_off.emit();
    run(200ms);
    power();
    ASSERT_TRUE(client->move_to.send(10.0, 20.0));
    ASSERT_TRUE(until([&] { return !in_flight(client->move_to.state()); }));
    EXPECT_EQ(client->move_to.state(), CommandState::rejected);
}

TEST_F(AxisWithoutPower, executes_homing_position_and_velocity_commands) {
    servo.set_home(3);
    power();
    EXPECT_TRUE(does(client->home));
    EXPECT_NEAR(servo.position(), 0, 1e-3);
    client->home.reset();
    EXPECT_TRUE(does(client->move_to, 25.0, 80.0));
    EXPECT_NEAR(servo.position(), 25, 1e-3);
    ASSERT_TRUE(client->move_at.send(-40.0));
    EXPECT_TRUE(until([&] { return servo.velocity() == -40; }));
    EXPECT_EQ(axis->state.last(), AxisMode::continuous_motion);
    EXPECT_TRUE(does(client->come_to_stop));
    EXPECT_EQ(servo.velocity(), 0);
    EXPECT_EQ(axis->state.last(), AxisMode::stopping);
    client->release.emit();
    EXPECT_TRUE(reaches(AxisMode::standstill));
}

TEST_F(ServoAxis, follows_set_points_at_each_sync) {
    follow_positions();
    client->oscillates = true;
    run(2s);
    EXPECT_EQ(axis->state.last(), AxisMode::synchronized_motion);
    EXPECT_GT(client->worst_lag, 0);
    EXPECT_LT(client->worst_lag, 0.32) << "five cycles of 63 mm/s at most: out, SYNC, motion, SYNC, in";
    EXPECT_EQ(client->errors, 0);
}

TEST_F(ServoAxis, follows_the_substitute_of_its_row_for_a_stale_velocity) {
    ASSERT_TRUE(client->synchronize.send(9));
    client->oscillates = true;
    run(2100ms); // a tenth of a period: it moves
    ASSERT_GT(std::abs(axis->target_velocity.last()), 1.0);
    client->oscillates = false;
    run(100ms);
    EXPECT_EQ(axis->target_velocity.last(), 0.0);
    EXPECT_NEAR(servo.velocity(), 0.0, 1e-6);
}

TEST_F(ServoAxis, decelerates_to_rest_when_its_velocity_is_nan) {
    ASSERT_TRUE(client->synchronize.send(9));
    run(20ms);
    client->once = 20;
    run(10ms);
    ASSERT_EQ(axis->target_velocity.last(), 20);
    client->once = std::nan("");
    run(10ms);
    EXPECT_EQ(axis->target_velocity.last(), 0);
}

TEST_F(ServoAxis, starts_no_motion_with_an_earlier_set_point) {
    follow_positions();
    client->once = 1;
    run(500ms);
    ASSERT_NEAR(servo.position(), 1, 0.1);
    ASSERT_TRUE(client->synchronize.send(9));
    run(500ms);
    EXPECT_NEAR(servo.velocity(), 0, 1e-6) << "a place is no velocity, and it is stale";
    client->once = 30;
    run(10ms);
    EXPECT_EQ(axis->target_velocity.last(), 30);
}

TEST_F(ServoAxis, does_not_take_a_position_for_a_velocity) {
    follow_positions();
    client->oscillates = true;
    run(2200ms);
    client->synchronize.reset();
    ASSERT_TRUE(client->synchronize.send(9));
    ASSERT_TRUE(until([&] { return axis->mode.last() == 9; }));
    client->oscillates = false;
    run(5ms);
    EXPECT_EQ(axis->target_velocity.last(), 0);
    client->once = 3;
    run(5ms);
    EXPECT_EQ(axis->target_velocity.last(), 3);
}

TEST_F(ServoAxis, superimposes_a_motion_on_the_followed_set_points) {
    EXPECT_TRUE(does(client->superimpose, 1.0, 10.0, 500.0));
    EXPECT_NEAR(servo.position(), 1, 1e-3) << "from a stand: a relative motion";
    client->superimpose.reset();
    follow_positions();
    EXPECT_TRUE(does(client->superimpose, 4.0, 10.0, 500.0));
    EXPECT_EQ(axis->state.last(), AxisMode::synchronized_motion);
    run(20ms);
    EXPECT_NEAR(servo.position(), 5, 1e-3);
    client->superimpose.reset();
    ASSERT_TRUE(client->move_at.send(20.0));
    ASSERT_TRUE(until([&] { return servo.velocity() == 20; }));
    ASSERT_TRUE(client->superimpose.send(4.0, 10.0, 500.0));
    EXPECT_FALSE(ends(client->superimpose)) << "the drive makes this motion, and adds none to it";
    EXPECT_EQ(client->superimpose.state(), CommandState::rejected);
    EXPECT_EQ(axis->state.last(), AxisMode::continuous_motion);
}

TEST_F(ServoAxis, enters_error_stop_for_a_silent_node_and_recovers_by_a_reset) {
    ASSERT_TRUE(client->move_at.send(20.0));
    ASSERT_TRUE(until([&] { return servo.velocity() == 20; }));
    node.cut_off(true);
    EXPECT_TRUE(reaches(AxisMode::error_stop));
    EXPECT_EQ(client->errors, 1);
    run(200ms);
    EXPECT_FALSE(manager->operational.last());
    node.cut_off(false);
    ASSERT_TRUE(until([&] { return manager->operational.last(); }));
    run(100ms);
    EXPECT_EQ(axis->state.last(), AxisMode::error_stop) << "nobody reset it";
    client->reset.emit();
    EXPECT_TRUE(reaches(AxisMode::standstill));
    ASSERT_TRUE(servo.trip());
    EXPECT_TRUE(reaches(AxisMode::error_stop));
    EXPECT_EQ(client->errors, 2);
}

TEST_F(ServoAxis, rejects_commands_that_its_state_does_not_allow) {
    client->power_off.emit();
    EXPECT_TRUE(reaches(AxisMode::disabled));
    ASSERT_TRUE(client->move_at.send(20.0));
    EXPECT_FALSE(ends(client->move_at));
    EXPECT_EQ(client->move_at.state(), CommandState::rejected);
    ASSERT_TRUE(client->move_to.send(std::nan(""), 5.0));
    EXPECT_FALSE(ends(client->move_to));
}

TEST_F(ServoAxis, follows_set_points_after_one_with_a_future_time) {
    ASSERT_TRUE(client->synchronize.send(9));
    ASSERT_TRUE(until([&] { return axis->mode.last() == 9; }));
    client->once = 30;
    client->ahead = 900ms;
    run(3ms);
    EXPECT_EQ(axis->target_velocity.last(), 30.0);
    int stood = 0;
    for (int i = 0; i < 100; ++i) {
        client->once = 20;
        run(1ms);
        stood += axis->target_velocity.last() == 0;
    }
    EXPECT_EQ(axis->target_velocity.last(), 20.0);
    EXPECT_EQ(stood, 0);
}

TEST_F(ServoAxis, does_not_jump_after_a_position_with_a_future_time) {
    follow_positions();
    client->oscillates = true;
    run(1000ms);
    client->ahead = 740ms;
    double before = axis->target_position.last(), largest = 0;
    for (int i = 0; i < 1000; ++i) {
        run(1ms);
        largest = std::max(largest, std::abs(std::exchange(before, axis->target_position.last()) -
                                             axis->target_position.last()));
    }
    EXPECT_LT(largest, 0.1) << "of the oscillation: 0.063";
}

} // namespace
} // namespace tappet::test
