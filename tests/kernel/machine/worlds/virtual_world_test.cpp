// A machine in virtual time: nothing sleeps, every run of a seed is the same, and the component that caused
// an overrun is blamed.
#include "kernel/machine/check/time.hpp"

#include "kernel/base/random.hpp"
#include "tests/kernel/machine/virtual_rig.hpp"
#include "tests/kernel/machine/watched_machine.hpp"

#include <gmock/gmock.h>

namespace tappet {
namespace {

using watched::Order;
using watched::Worker;

template <const auto& table>
struct Rig : ConfiguredRig<table> {
    /// `seed`: enables random cycle times.
    explicit Rig(std::optional<std::uint64_t> seed = {}) {
        watched::stops().clear();
        if (seed) this->world.take_times(*seed);
        this->world.start();
    }
    Worker& worker(std::string_view name) { return this->template the<Worker>(name); }
    const Engine& engine(std::size_t activity) { return this->instance.engines()[activity]; }
};

TEST(VirtualWorld, runs_every_activity_at_its_period_and_skips_idle_time) {
    Rig<watched::table> rig;
    EXPECT_TRUE(rig.world.run_until(at_ns(0) + 10s));
    EXPECT_EQ(rig.clock.now(), at_ns(0) + 10s);
    EXPECT_EQ(rig.worker("driver").cycles, 5'000u);
    EXPECT_EQ(rig.worker("middle").cycles, 10'000u);
    EXPECT_EQ(rig.worker("logic").cycles, 2'000u);
    EXPECT_EQ(rig.world.steps(), 17'000u);
}

TEST(VirtualWorld, withholds_cycles_only_from_the_activity_that_hangs) {
    Rig<watched::table> rig;
    EXPECT_TRUE(rig.world.run_until(at_ns(0) + 1s));
    const auto middle = rig.worker("middle").cycles, driver = rig.worker("driver").cycles;
    rig.world.hang(
        rig.instance.machine().index.activity[find_component(rig.instance.machine().table, "middle")],
        rig.clock.now() + 500ms);
    EXPECT_TRUE(rig.world.run_until(at_ns(0) + 1499ms));
    EXPECT_EQ(rig.worker("middle").cycles, middle);
    EXPECT_EQ(rig.worker("driver").cycles, driver + 249);
    EXPECT_TRUE(rig.world.run_until(at_ns(0) + 2s));
    EXPECT_NEAR(static_cast<double>(rig.worker("middle").cycles - middle), 500.0, 2.0);
}

/// Cycles take time, up to the maximum of the analysis.
TEST(VirtualWorld, uses_cycle_times_up_to_the_budget_within_the_analysed_response) {
    const AcceptedMachine machine = AtRunTime<watched::table, test_board>::machine();
    std::vector<int> processors;
    for (const ActivityPlan& plan : machine.plan.activities) processors.push_back(plan.processor);
    Duration longest{};
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        Rig<watched::table> rig{seed};
        EXPECT_TRUE(rig.world.run_until(at_ns(0) + 10s));
        for (std::size_t a = 0; a < processors.size(); ++a) {
            const ActivityRow& row = machine.table.activities[a];
            if (!row.real_time) continue;
            const Response analysed =
                checks::worst_response(machine.table, machine.index.rank, processors,
                                       checks::find_on_grid(machine.table, machine.index.activity), a);
            EXPECT_LE(rig.world.longest_response(a).count(), analysed.worst_ns)
                << row.name << ", seed " << seed;
            EXPECT_GE(rig.world.longest_response(a), row.budget_each) << row.name << ", seed " << seed;
            longest = std::max(longest, rig.world.longest_response(a) - row.budget_each);
        }
    }
    EXPECT_GT(longest, 0us) << "none was preempted";
}

/// A thread that is delayed in the middle of its cycle resumes it on return.
TEST(VirtualWorld, resumes_a_cycle_after_a_hang_in_the_middle_of_it) {
    Rig<watched::table> rig{1};
    const auto a = find_component(rig.instance.machine().table, "driver");
    const std::size_t activity = rig.instance.machine().index.activity[a];
    for (int period = 1; period <= 100; ++period) {
        const Time begin = at_ns(0) + period * 2ms;
        EXPECT_TRUE(rig.world.run_until(begin)); // a cycle starts
        rig.world.hang(activity, begin + 300us);
    }
    EXPECT_GT(rig.worker("driver").cycles, 90u);
    EXPECT_LT(rig.world.longest_response(activity), 300us);
}

TEST(VirtualWorld, stops_the_last_row_first) {
    Rig<watched::table> rig;
    EXPECT_TRUE(rig.world.run_until(at_ns(0) + 20ms));
    rig.world.stop();
    EXPECT_THAT(watched::stops(), testing::ElementsAre("logic", "left", "middle", "right", "driver"));
    EXPECT_EQ(rig.worker("driver").level.last(), 0);
}

/// The component functions that a restart runs take seconds.
TEST(VirtualWorld, lets_user_functions_take_time_while_others_continue) {
    Rig<watched::table> rig;
    EXPECT_TRUE(rig.world.run_until(at_ns(0) + 1s));
    const auto logic = rig.worker("logic").cycles, middle = rig.worker("middle").cycles;
    rig.world.makers_take(7s);
    const LifeTicket ticket = rig.instance.life().ask_activity(watched::logic, LifeChange::restart);
    const auto outcome = [&] {
        return rig.instance.life().answer_of_activity(watched::logic, ticket).outcome;
    };
    EXPECT_TRUE(rig.world.run_until(at_ns(0) + 7999ms));
    EXPECT_EQ(outcome(), LifeOutcome::pending);
    EXPECT_EQ(rig.worker("logic").level.last(), 0) << "safe, since it stands";
    EXPECT_NEAR(static_cast<double>(rig.worker("logic").cycles), static_cast<double>(logic), 1.0);
    EXPECT_NEAR(static_cast<double>(rig.worker("middle").cycles - middle), 6999.0, 2.0);
    EXPECT_TRUE(rig.world.run_until(at_ns(0) + 9s));
    EXPECT_EQ(outcome(), LifeOutcome::done);
    EXPECT_NEAR(static_cast<double>(rig.worker("logic").cycles - logic), 200.0, 2.0);
}

TEST(VirtualWorld, stops_within_its_bound_during_user_functions_and_ends_other_changes) {
    Rig<watched::strict_table> rig;
    EXPECT_TRUE(rig.world.run_until(at_ns(0) + 20ms));
    rig.world.makers_take(7s);
    const LifeTicket ticket = rig.instance.life().ask_activity(watched::logic, LifeChange::restart);
    EXPECT_TRUE(rig.world.run_until(at_ns(0) + 40ms));
    rig.worker("right").order = Order::overrun;
    EXPECT_FALSE(rig.world.run_until(at_ns(0) + 30s));
    rig.world.stop();
    EXPECT_LT(rig.clock.now() - rig.instance.stop_asked_at(), test_board.stop_within);
    for (const char* name : {"driver", "left", "middle", "right", "logic"})
        EXPECT_EQ(rig.worker(name).at_wire.load(), 0) << name;
    EXPECT_EQ(rig.instance.life().answer_of_activity(watched::logic, ticket).refusal,
              LifeRefusal::activity_stopped);
    EXPECT_TRUE(rig.instance.standing());
}

TEST(VirtualWorld, never_executes_a_request_that_it_refused_before_the_start) {
    ConfiguredRig<watched::table> rig;
    MachineInstance& instance = rig.instance;
    const std::size_t middle = find_component(instance.machine().table, "middle");
    const LifeTicket ticket = instance.life().ask_component(middle, LifeChange::stop);
    EXPECT_EQ(instance.life().answer_of_component(middle, ticket).refusal, LifeRefusal::activity_stopped);
    rig.world.start();
    EXPECT_TRUE(rig.run(100ms));
    EXPECT_EQ(instance.life().state_of(middle), ComponentState::running);
    rig.world.stop();
}

TEST(VirtualWorldDeathTest, refuses_a_change_of_a_running_engine_that_must_stand) {
    Rig<watched::table> rig;
    Engine& engine = rig.instance.engines()[0];
    EXPECT_FALSE(rig.instance.standing());
    constexpr auto* sentence =
        "contract 107 engine-runs: A function for a stopped engine was called while activity 0 ran";
    EXPECT_DEATH(engine.place(engine.plan(), rig.clock), sentence);
    EXPECT_DEATH(static_cast<void>(engine.initialise()), sentence);
    EXPECT_DEATH(engine.finalise(), sentence);
    EXPECT_DEATH(static_cast<void>(engine.readiness(rig.clock.now())), sentence);
    EXPECT_DEATH(static_cast<void>(rig.instance.configure({})), "contract 107");
    rig.world.stop();
    EXPECT_TRUE(rig.instance.standing());
}

TEST(VirtualWorld, runs_processes_before_the_engines_of_the_same_instant) {
    struct Feeder {
        Time due = at_ns(0) + 3ms;
        Worker* middle = nullptr;
        std::uint64_t seen = 0;
    } feeder;
    Rig<watched::table> rig;
    feeder.middle = &rig.worker("middle");
    rig.world.add({&feeder, [](void* self) { return static_cast<Feeder*>(self)->due; },
                   [](void* self, Time) {
                       auto& at = *static_cast<Feeder*>(self);
                       at.seen = at.middle->cycles;
                       at.due = never;
                   }});
    EXPECT_TRUE(rig.world.run_until(at_ns(0) + 10ms));
    EXPECT_EQ(feeder.seen, 2u); // those at 1 and 2 ms
}

TEST(VirtualWorld, stops_by_row_and_names_the_activity_and_its_slow_component) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        Random random{seed};
        const std::string_view victim = watched::of_motion[random.below(watched::of_motion.size())];
        Rig<watched::strict_table> rig;
        EXPECT_TRUE(rig.world.run_until(at_ns(0) + 20ms));
        rig.worker(victim).order = Order::overrun;
        EXPECT_FALSE(rig.world.run_until(at_ns(0) + 300ms));
        EXPECT_LT(rig.clock.now(), at_ns(0) + 30ms);
        EXPECT_EQ(rig.instance.stop_request().reason, StopReason::missed_deadline);
        EXPECT_EQ(
            rig.instance.describe_stop().view(),
            Sentence("activity \"motion\" missed its deadline: component \"", victim, "\" took the time")
                .view());
    }
}

} // namespace
} // namespace tappet
