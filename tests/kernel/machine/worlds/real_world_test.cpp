// A machine in threads of its own under real time. What needs SCHED_FIFO is left out, and says so, where it
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

TEST_F(InRealTime, arms_runs_and_stops_the_last_row_first) {
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

TEST_F(InRealTime, takes_no_page_fault_in_a_real_time_thread) {
    if constexpr (os::heap::sanitizer_owns_malloc)
        GTEST_SKIP() << "a sanitizer's shadow is mapped as it is used";
    Rig<watched::table> rig;
    ASSERT_TRUE(rig.runs());
    EXPECT_TRUE(rig.world.supervise(300ms));
    EXPECT_EQ(rig.world.stop(), 0);
    EXPECT_EQ(rig.world.page_faults_in_real_time_threads(), 0u);
}

TEST_F(InRealTime, blames_an_overrun_on_the_component_that_took_the_time) {
    Random random{static_cast<std::uint64_t>(getpid())};
    const std::string_view victim = watched::of_motion[random.below(watched::of_motion.size())];
    Rig<watched::table> rig;
    ASSERT_TRUE(rig.runs());
    rig.worker(victim).overrun = 50ms; // longer than any other delay of this box, one hopes
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

TEST_F(InRealTime, stops_for_a_late_cycle_where_the_row_says_so) {
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

TEST_F(InRealTime, a_broken_contract_stops_the_machine_with_its_sentence_and_leaves_all_safe) {
    Rig<watched::parked_table> rig;
    ASSERT_TRUE(rig.runs());
    rig.worker("middle").order = Order::break_contract;
    for (int n = 0; n < 20 && rig.world.supervise(100ms); ++n) {
    }
    ASSERT_TRUE(rig.instance.stop_asked());
    EXPECT_EQ(rig.world.stop(), 0) << "the thread whose contract is broken leaves its safe values itself";
    EXPECT_EQ(rig.world.lost(), 1);
    EXPECT_FALSE(rig.instance.standing()) << "and goes on nowhere";
    EXPECT_EQ(rig.instance.stop_request().reason, StopReason::broken_contract);
    EXPECT_EQ(rig.instance.describe_stop().view(), "a contract was broken in activity \"motion\"");
    EXPECT_THAT(std::string{rig.world.broken_contract().view()},
                testing::HasSubstr("A function was called with 7, which its declaration forbids."));
    for (const char* name : {"driver", "left", "middle", "right", "logic"})
        EXPECT_EQ(rig.worker(name).at_wire.load(), 0) << name;
    EXPECT_THAT(watched::stops(), testing::ElementsAre("logic", "left", "middle", "right", "driver"));
}

TEST_F(InRealTime, a_breach_during_the_stop_is_kept_beside_the_first_one_and_beside_a_request_to_stop) {
    auto& rig = *new Rig<watched::twice_broken_table>; // a thread that was given up, and nobody joins, may
                                                       // look at it for ever
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

/// The process ends here when the supervisor's contract was broken: were all safe by then?
Rig<watched::supervised_table>* at_the_end = nullptr;

using InRealTimeDeathTest = InRealTime;

TEST_F(InRealTimeDeathTest, a_contract_broken_on_the_supervisors_thread_stops_the_machine_before_it_ends) {
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

TEST_F(InRealTime, what_is_not_real_time_and_blocks_does_not_hold_up_the_stop_of_the_others) {
    Rig<watched::blocked_table> rig;
    ASSERT_TRUE(rig.runs());
    auto& console = rig.the<watched::Blocking>("console");
    console.until_safe = &rig.worker("logic").at_wire;
    while (!console.blocks) os::sleep_for(1ms);
    EXPECT_EQ(rig.world.stop(), 0) << "waited for, it would have hung until it was given up";
    EXPECT_TRUE(console.finalised);
}

/// Of a machine whose logic did so some times. The first cycle warms caches and counts as no maximum; from
/// the one that is too long on it is measured.
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

TEST_F(InRealTime, asks_the_processor_time_and_not_the_clock_whether_a_budget_is_kept) {
    const EngineStatistics waited = after(Order::sleep);
    EXPECT_GE(waited.longest_busy, 20ms);
    EXPECT_EQ(waited.over_claim, 0u) << "others could have run";
    EXPECT_GE(after(Order::overrun).over_claim, 1u);
}

TEST_F(InRealTime, a_signal_that_would_end_or_freeze_the_process_ends_the_supervision_as_a_request) {
    for (const int number : {SIGTERM, SIGINT, SIGHUP, SIGQUIT, SIGTSTP, SIGUSR1}) {
        Rig<watched::table> rig;
        ASSERT_TRUE(rig.runs());
        EXPECT_TRUE(rig.world.supervise(50ms));
        raise(SIGPIPE); // is none: a reader went away
        EXPECT_TRUE(rig.world.supervise(50ms));
        raise(number);
        EXPECT_FALSE(rig.world.supervise(1s)) << number;
        EXPECT_EQ(rig.instance.stop_request().reason, StopReason::requested);
        EXPECT_EQ(rig.instance.describe_stop().view(), "asked for from outside");
        EXPECT_EQ(rig.world.stop(), 0);
    }
}

TEST_F(InRealTime, a_thread_that_hangs_is_reported_and_nobody_runs_its_stop) {
    // A hung thread of high priority would keep the supervisor from its processor: it spins on the other one.
    if (sysconf(_SC_NPROCESSORS_ONLN) < 2) GTEST_SKIP() << "one processor: the hung thread would have it";
    auto& rig = *new Rig<watched::hung_table>; // a thread that was given up, and nobody joins, may look at it
                                               // for ever
    ASSERT_TRUE(rig.runs());
    rig.worker("logic").order = Order::hang;
    EXPECT_TRUE(rig.world.supervise(50ms));
    EXPECT_EQ(rig.world.stop(), 1);
    EXPECT_EQ(rig.world.first_hung(), "logic");
    EXPECT_EQ(rig.worker("logic").at_wire.load(), 1) << "its guardian ends it, where there is one";
    EXPECT_EQ(rig.worker("driver").at_wire.load(), 0);
    EXPECT_FALSE(rig.instance.standing());
    rig.worker("logic").let_go = true; // the thread comes back when all is over, and touches nothing any more
    for (int n = 0; n < 1000 && rig.world.activity(watched::logic).state() != Activity::State::stopped; ++n)
        os::sleep_for(1ms);
    EXPECT_EQ(rig.world.activity(watched::logic).state(), Activity::State::stopped);
    EXPECT_THAT(watched::stops(), testing::ElementsAre("left", "middle", "right", "driver"));
}

} // namespace
} // namespace tappet
