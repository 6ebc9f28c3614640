// Restarts of a CAN bus are deliberate, separated by a pause, and limited in number.
#include "tests/drivers/components/can_machine.hpp"

namespace tappet::test {
namespace {

/// Two attempts, 100 ms apart.
struct CanRestarter : CanMachine {
    void SetUp() override { run_until(20ms); }
};

TEST_F(CanRestarter, restarts_a_faulted_bus_after_its_pause) {
    wire.bus_off(twin);
    run_until(115ms);
    EXPECT_EQ(twin.counters().restarts, 0u) << "not before the pause is over";
    EXPECT_EQ(restarter->restarts.last(), 0);
    run_until(160ms);
    EXPECT_EQ(restarter->restarts.last(), 1);
    EXPECT_EQ(twin.counters().restarts, 1u);
    EXPECT_EQ(master->recoveries, 1);
    EXPECT_EQ(master->surrenders, 0);
}

TEST_F(CanRestarter, gives_up_when_the_bus_faults_again_and_again) {
    wire.set_acknowledged(false); // each restart ends in the same fault
    run_until(5s);
    EXPECT_EQ(restarter->restarts.last(), 2);
    EXPECT_EQ(master->faults, 3);
    EXPECT_EQ(master->recoveries, 2);
    EXPECT_EQ(master->surrenders, 1) << "told once";
    EXPECT_TRUE(master->was_faulted);
    const auto silent = heard.size();
    wire.set_acknowledged(true);
    run_until(6s);
    EXPECT_LE(heard.size(), silent + 4) << "what the controller itself held; nothing new";
    EXPECT_TRUE(master->was_faulted) << "it stays so";
}

TEST_F(CanRestarter, gives_up_when_restarts_fail) {
    twin.make_restarts_fail(true);
    wire.bus_off(twin);
    run_until(2s);
    EXPECT_EQ(restarter->restarts.last(), 0);
    EXPECT_EQ(master->surrenders, 1);
}

TEST_F(CanRestarter, gives_up_when_its_device_allows_no_more_restarts) {
    restarter->attempts.set(100);
    wire.set_acknowledged(false);
    run_until(5s);
    EXPECT_EQ(restarter->restarts.last(), 3);
    EXPECT_EQ(master->surrenders, 1);
}

TEST_F(CanRestarter, gives_up_at_once_on_a_new_fault_without_attempts_left) {
    for (int i = 0; i < 2; ++i) {
        wire.bus_off(twin);
        run(300ms);
        ASSERT_EQ(master->recoveries, i + 1);
    }
    wire.bus_off(twin);
    run(50ms);
    EXPECT_EQ(master->surrenders, 1);
    EXPECT_EQ(restarter->restarts.last(), 2);
}

TEST_F(CanRestarter, retries_after_a_stop_and_a_start) {
    for (int i = 0; i < 2; ++i) {
        wire.bus_off(twin);
        run(300ms);
    }
    wire.bus_off(twin);
    run(1s);
    ASSERT_EQ(master->surrenders, 1);
    change(2, LifeChange::stop); // an operator had a look
    run(100ms);
    change(2, LifeChange::start);
    EXPECT_EQ(restarter->restarts.last(), 0);
    run(90ms);
    EXPECT_EQ(master->recoveries, 2) << "not before its pause";
    run(300ms);
    EXPECT_EQ(master->recoveries, 3);
    EXPECT_EQ(restarter->restarts.last(), 1);
    EXPECT_EQ(master->surrenders, 1);
}

TEST_F(CanRestarter, leaves_a_healthy_bus_alone) {
    run_until(3s);
    EXPECT_EQ(twin.counters().restarts, 0u);
    EXPECT_EQ(master->surrenders, 0);
}

} // namespace
} // namespace tappet::test
