// A machine in its own threads in real time. Tests that need SCHED_FIFO are skipped with a message where it
// is not granted.
#include "kernel/base/random.hpp"
#include "kernel/os/heap.hpp"
#include "tests/kernel/machine/real_rig.hpp"
#include "tests/kernel/machine/watched_machine.hpp"

#include <gmock/gmock.h>

#include <csignal>

namespace tappet {
namespace {

using watched::Order;
using watched::Worker;

template <const auto& table>
struct Rig : RealRig<table> {
    Rig() { watched::stops().clear(); }
    Worker& worker(std::string_view name) { return this->template the<Worker>(name); }
};

TEST_F(InRealTime, the_machine_arms_runs_and_stops_the_last_row_first) {
    Rig<watched::table> rig;
    ASSERT_TRUE(rig.runs());
    EXPECT_TRUE(rig.report.can_arm());
    EXPECT_TRUE(rig.world.supervise(300ms));
    EXPECT_EQ(rig.world.stop(), 0);
    EXPECT_THAT(watched::stops(), testing::ElementsAre("logic", "left", "middle", "right", "driver"));
    EXPECT_GT(rig.worker("middle").cycles, 100u);
    EXPECT_EQ(rig.worker("driver").at_wire.load(), 0);
    EXPECT_FALSE(rig.instance.stop_asked());
}

// A board that even asks for a warning only.
constexpr Board board_of_box = [] {
    Board board = real_board;
    board.world = "box";
    static_cast<void>(board.only_warned.push("effects"));
    return board;
}();

TEST_F(InRealTime, a_machine_whose_effects_nobody_checked_arms_on_host_and_bench_only) {
    const auto finding = [](const os::ArmingReport& report) {
        return *std::ranges::find(report.findings(), "effects", &os::Finding::name);
    };
    Rig<watched::table> on_host;
    ASSERT_TRUE(on_host.arm());
    EXPECT_EQ(finding(on_host.report).severity, os::Severity::warning);
    RealRig<watched::table, board_of_box> on_box;
    EXPECT_FALSE(on_box.arm());
    EXPECT_EQ(finding(on_box.report).severity, os::Severity::refused) << "no board downgrades it";
    EXPECT_THAT(finding(on_box.report).cure.view(), testing::HasSubstr("install clang-22"));
}

TEST_F(InRealTime, a_machine_whose_effects_are_checked_arms_on_a_box) {
    static AcceptedMachine machine = AtRunTime<watched::table, board_of_box>::machine();
    machine.table.effects_checked = true;
    os::Clock clock{os::Clock::Kind::real};
    MachineInstance instance{machine, clock};
    RealWorld world{instance};
    os::ArmingReport report{{board_of_box.only_warned.begin(), board_of_box.only_warned.end()}};
    ASSERT_TRUE(instance.configure({}));
    EXPECT_TRUE(world.arm(report, 2));
}

TEST_F(InRealTime, a_real_time_thread_has_no_page_faults) {
    if constexpr (os::heap::sanitizer_owns_malloc)
        GTEST_SKIP() << "a sanitizer's shadow is mapped as it is used";
    Rig<watched::table> rig;
    ASSERT_TRUE(rig.runs());
    EXPECT_TRUE(rig.world.supervise(300ms));
    EXPECT_EQ(rig.world.stop(), 0);
    EXPECT_EQ(rig.world.page_faults_in_real_time_threads(), 0u);
}

TEST_F(InRealTime, an_overrun_is_blamed_on_the_slow_component) {
    Random random{static_cast<std::uint64_t>(getpid())};
    const std::string_view victim = watched::of_motion[random.below(watched::of_motion.size())];
    Rig<watched::table> rig;
    ASSERT_TRUE(rig.runs());
    rig.worker(victim).overrun = 50ms; // longer than any other delay of this box, with luck
    EXPECT_TRUE(rig.world.supervise(100ms));
    rig.worker(victim).order = Order::overrun;
    EXPECT_TRUE(rig.world.supervise(150ms));
    EXPECT_EQ(rig.world.stop(), 0);
    const Engine& engine = rig.instance.engines()[watched::motion];
    std::string_view blamed = "nobody";
    Duration most{};
    for (const Miss& miss : engine.statistics().recent_misses) {
        if (miss.took <= most) continue;
        most = miss.took;
        blamed = watched::culprit(engine, miss);
    }
    EXPECT_EQ(blamed, victim);
    EXPECT_GE(most, 50ms);
    EXPECT_GE(engine.statistics().skipped_periods, 49u);
}

TEST_F(InRealTime, a_late_cycle_stops_the_machine_where_the_row_says_so) {
    Rig<watched::strict_table> rig;
    ASSERT_TRUE(rig.runs());
    rig.worker("right").overrun = 50ms;
    rig.worker("right").order = Order::overrun;
    while (rig.world.supervise(1s)) {
    }
    EXPECT_EQ(rig.world.stop(), 0);
    EXPECT_EQ(rig.instance.stop_request().reason, StopReason::missed_deadline);
    EXPECT_THAT(std::string{rig.instance.describe_stop().view()},
                testing::StartsWith("activity \"motion\" missed its deadline: "));
    EXPECT_EQ(rig.worker("driver").at_wire.load(), 0);
}

TEST_F(InRealTime, a_broken_contract_stops_the_machine_safely_with_its_message) {
    Rig<watched::parked_table> rig;
    ASSERT_TRUE(rig.runs());
    rig.worker("middle").order = Order::break_contract;
    for (int n = 0; n < 20 && rig.world.supervise(100ms); ++n) {
    }
    ASSERT_TRUE(rig.instance.stop_asked());
    EXPECT_EQ(rig.world.stop(), 0) << "the thread whose contract is broken leaves its safe values itself";
    EXPECT_EQ(rig.world.lost(), 1);
    EXPECT_FALSE(rig.instance.standing())
        << "the thread that broke the contract was abandoned, and counts as running";
    EXPECT_EQ(rig.instance.stop_request().reason, StopReason::broken_contract);
    EXPECT_EQ(rig.instance.describe_stop().view(), "a contract was broken in activity \"motion\"");
    EXPECT_THAT(std::string{rig.world.broken_contract().view()},
                testing::HasSubstr("A function was called with 7, which its declaration forbids."));
    for (const char* name : {"driver", "left", "middle", "right", "logic"})
        EXPECT_EQ(rig.worker(name).at_wire.load(), 0) << name;
    EXPECT_THAT(watched::stops(), testing::ElementsAre("logic", "left", "middle", "right", "driver"));
}

TEST_F(InRealTime, a_breach_during_the_stop_is_recorded_beside_the_first_cause) {
    auto& rig = *new Rig<watched::twice_broken_table>; // an abandoned thread may read it for ever
    ASSERT_TRUE(rig.runs());
    rig.worker("driver").breaks_at_stop = rig.worker("logic").breaks_at_stop = true;
    raise(SIGTERM);
    EXPECT_FALSE(rig.world.supervise(1s));
    EXPECT_EQ(rig.world.stop(), 2);
    EXPECT_EQ(rig.instance.stop_request().reason, StopReason::requested);
    ASSERT_EQ(rig.world.breaches(), 2u);
    for (std::size_t i = 0; i < 2; ++i)
        EXPECT_THAT(std::string{rig.world.describe_breach(i).view()},
                    testing::HasSubstr("A function was called with 8, which its declaration forbids."));
    for (const char* name : {"driver", "left", "middle", "right", "logic"})
        EXPECT_EQ(rig.worker(name).at_wire.load(), 0) << name;
}

/// Reached when the supervisor broke its contract and the process ends: were all outputs safe by then?
Rig<watched::supervised_table>* at_the_end = nullptr;

using InRealTimeDeathTest = InRealTime;

TEST_F(InRealTimeDeathTest, a_contract_broken_by_the_supervisor_stops_the_machine_first) {
    testing::FLAGS_gtest_death_test_style = "threadsafe";
    EXPECT_EXIT(
        {
            Rig<watched::supervised_table> rig;
            if (!rig.runs()) std::_Exit(2);
            at_the_end = &rig;
            std::signal(SIGABRT, [](int) {
                bool safe = true;
                for (const char* name : {"driver", "left", "middle", "right", "logic"})
                    safe &= at_the_end->worker(name).at_wire.load() == 0;
                std::_Exit(safe ? 0 : 1);
            });
            TAPPET_CONTRACT(false, Contract::precondition, 9);
        },
        testing::ExitedWithCode(0), "A function was called with 9");
}

TEST_F(InRealTime, a_blocking_activity_does_not_delay_the_stop_of_others) {
    Rig<watched::blocked_table> rig;
    ASSERT_TRUE(rig.runs());
    auto& console = rig.the<watched::Blocking>("console");
    console.until_safe = &rig.worker("logic").at_wire;
    while (!console.blocks) os::sleep_for(1ms);
    EXPECT_EQ(rig.world.stop(), 0)
        << "if the stop waited for the console first, the console would block until the stop abandoned it";
    EXPECT_TRUE(console.finalised);
}

/// The statistics of a machine whose logic received the order several times. The first cycle warms caches and
/// does not count for the maximum; measurement starts with the first overlong cycle.
EngineStatistics after(Order order) {
    Rig<watched::blocked_table> rig;
    EXPECT_TRUE(rig.runs());
    Worker& logic = rig.worker("logic");
    logic.overrun = 20ms;
    for (int n = 0; n < 4; ++n) {
        logic.order = order;
        while (logic.order != Order::none) static_cast<void>(rig.world.supervise(50ms));
    }
    static_cast<void>(rig.world.supervise(100ms));
    EXPECT_EQ(rig.world.stop(), 0);
    return rig.instance.engines()[1].statistics();
}

TEST_F(InRealTime, a_budget_is_checked_against_processor_time) {
    const EngineStatistics waited = after(Order::sleep);
    EXPECT_GE(waited.longest_busy, 20ms);
    EXPECT_EQ(waited.over_claim, 0u) << "a sleeping thread uses no processor time";
    EXPECT_GE(after(Order::overrun).over_claim, 1u);
}

TEST_F(InRealTime, a_terminating_signal_becomes_a_stop_request) {
    for (const int number : {SIGTERM, SIGINT, SIGHUP, SIGQUIT, SIGTSTP, SIGUSR1}) {
        Rig<watched::table> rig;
        ASSERT_TRUE(rig.runs());
        EXPECT_TRUE(rig.world.supervise(50ms));
        raise(SIGPIPE); // does not count: a reader went away
        EXPECT_TRUE(rig.world.supervise(50ms));
        raise(number);
        EXPECT_FALSE(rig.world.supervise(1s)) << number;
        EXPECT_EQ(rig.instance.stop_request().reason, StopReason::requested);
        EXPECT_EQ(rig.instance.describe_stop().view(), "requested from outside");
        EXPECT_EQ(rig.world.stop(), 0);
    }
}

TEST_F(InRealTime, a_hung_thread_is_reported_and_its_stop_is_not_run) {
    // A hung thread of high priority would occupy the supervisor's processor, so it spins on the other one.
    if (sysconf(_SC_NPROCESSORS_ONLN) < 2) GTEST_SKIP() << "one processor: the hung thread would have it";
    auto& rig = *new Rig<watched::hung_table>; // an abandoned thread may read it for ever
    ASSERT_TRUE(rig.runs());
    rig.worker("logic").order = Order::hang;
    EXPECT_TRUE(rig.world.supervise(50ms));
    EXPECT_EQ(rig.world.stop(), 1);
    EXPECT_EQ(rig.world.first_hung(), "logic");
    EXPECT_EQ(rig.worker("logic").at_wire.load(), 1) << "its guardian ends it, where there is one";
    EXPECT_EQ(rig.worker("driver").at_wire.load(), 0);
    EXPECT_FALSE(rig.instance.standing());
    rig.worker("logic").let_go = true; // the thread returns at the end and touches nothing any more
    for (int n = 0; n < 1000 && rig.world.activity(watched::logic).state() != Activity::State::stopped; ++n)
        os::sleep_for(1ms);
    EXPECT_EQ(rig.world.activity(watched::logic).state(), Activity::State::stopped);
    EXPECT_THAT(watched::stops(), testing::ElementsAre("left", "middle", "right", "driver"));
}

} // namespace
} // namespace tappet
