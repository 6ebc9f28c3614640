// An axis with a forced set point, during the force and when it ends.
#include "tests/drivers/canopen/servo_axis.hpp"
#include "tests/drivers/components/forced_port.hpp"

namespace tappet::test {
namespace {

/// Its set point is forced for less time than the hidden value needs to become stale.
struct ForcedAxis : ServoAxis {
    void force(double value) {
        set_point.to(value);
        run(4ms);
    }
    void release() {
        set_point.release();
        run(3ms);
    }
    void write(double value) {
        client->once = value;
        run(3ms);
    }
    ForcedPort set_point{instance, "axis.set_point", FacetKind::input};
};

TEST_F(ForcedAxis, stops_when_a_force_ends_with_no_value_behind_it) {
    ASSERT_TRUE(client->synchronize.send(9));
    ASSERT_TRUE(until([&] { return axis->mode.last() == 9; }));
    force(30);
    EXPECT_EQ(axis->target_velocity.last(), 30);
    release();
    EXPECT_EQ(axis->target_velocity.last(), 0);
}

TEST_F(ForcedAxis, does_not_jump_to_a_position_hidden_by_a_force) {
    follow_positions();
    write(1);
    force(1.5);
    ASSERT_NEAR(axis->target_position.last(), 1.5, 1e-9);
    release();
    EXPECT_NEAR(axis->target_position.last(), 1.5, 1e-9);
}

TEST_F(ForcedAxis, stops_when_the_force_of_its_velocity_ends) {
    ASSERT_TRUE(client->synchronize.send(9));
    run(20ms);
    write(30);
    force(20);
    ASSERT_EQ(axis->target_velocity.last(), 20);
    release();
    EXPECT_EQ(axis->target_velocity.last(), 0);
}

TEST_F(ForcedAxis, ignores_values_written_before_it_follows) {
    write(30);
    force(20);
    ASSERT_TRUE(client->synchronize.send(9));
    run(3ms);
    release();
    EXPECT_EQ(axis->target_velocity.last(), 0);
}

TEST_F(ForcedAxis, stops_when_its_writer_stops_behind_a_force) {
    ASSERT_TRUE(client->synchronize.send(9));
    run(20ms);
    write(10);
    force(0);
    write(30);
    static_cast<void>(
        instance.life().ask_component(find_component(instance.machine().table, "client"), LifeChange::stop));
    for (int i = 0; i < 200; ++i) {
        run(1ms);
        ASSERT_EQ(axis->target_velocity.last(), 0);
    }
}

} // namespace
} // namespace tappet::test
