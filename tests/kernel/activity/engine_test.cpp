// The execution engine in virtual time: cycle order, timers, messages, deadlines and the function that missed
// them; the start of its periods, and parts that run by turns.
#include "tests/kernel/activity/execution_engine.hpp"

namespace tappet {
namespace {

/// A behaviour that requests one step at a time.
struct Wish {
    Log* log;
    Time at = never;
    static Behaviour behaviour(Wish& wish) {
        Behaviour each;
        each.self = &wish;
        each.start = [](void*, Time) noexcept TAPPET_REALTIME {};
        each.step = [](void* self, Time) noexcept TAPPET_REALTIME {
            static_cast<Wish*>(self)->at = never;
            static_cast<Wish*>(self)->log->add("behaviour");
            return true;
        };
        each.stop = [](void* self, Time) noexcept
            TAPPET_REALTIME { static_cast<Wish*>(self)->log->add("behaviour stops"); };
        each.next = [](const void* self) noexcept
            TAPPET_REALTIME { return static_cast<const Wish*>(self)->at; };
        return each;
    }
};

struct EngineWithABehaviour : ExecutionEngine {
    Wish wish{&log};
    std::array<Behaviour, 1> behaviours{Wish::behaviour(wish)};

    EngineWithABehaviour() { plan.behaviours = behaviours; }
};

TEST_F(EngineWithABehaviour, runs_timers_then_components_then_messages_then_behaviours) {
    begin();
    workers[1].timer.arm(at_ns(0) + period);
    tell(0);
    next_cycle();
    EXPECT_EQ(log.lines, (Lines{"b rings", "a steps", "b steps", "a hears", "behaviour"}));
    EXPECT_EQ(statistics().messages, 1u);
}

TEST_F(EngineWithABehaviour, starts_components_before_behaviours_and_stops_behaviours_first) {
    engine.place(plan, clock);
    engine.start(clock.now());
    EXPECT_EQ(log.lines, (Lines{"a starts", "b starts"}));
    for (const EnginePart& part : parts) EXPECT_EQ(part.state.load(), ComponentState::running);
    log.lines.clear();
    engine.stop(clock.now());
    for (const EnginePart& part : parts) EXPECT_EQ(part.state.load(), ComponentState::stopped);
    EXPECT_EQ(log.lines, (Lines{"behaviour stops", "a stops", "b stops"}));
}

TEST_F(ExecutionEngine, releases_cycles_at_whole_periods_even_after_a_late_one) {
    begin();
    EXPECT_EQ(engine.next_wake(), at_ns(0) + period);
    clock.advance_to(at_ns(0) + period + 70us);
    engine.run(false);
    EXPECT_EQ(workers[0].last.release, at_ns(0) + period);
    EXPECT_EQ(workers[0].last.now, at_ns(0) + period + 70us);
    EXPECT_EQ(workers[0].last.period, period);
    EXPECT_EQ(engine.next_wake(), at_ns(0) + 2 * period);
}

TEST_F(ExecutionEngine, runs_a_timer_between_two_periods_without_stepping_components) {
    begin();
    workers[0].timer.arm(at_ns(0) + 300us);
    EXPECT_EQ(engine.next_wake(), at_ns(0) + 300us);
    next_cycle();
    EXPECT_EQ(log.lines, (Lines{"a rings"}));
    EXPECT_EQ(workers[0].last.release, at_ns(0) + 300us);
    EXPECT_EQ(engine.next_wake(), at_ns(0) + period) << "a one-shot timer";
}

TEST_F(ExecutionEngine, skips_missed_periods_of_a_timer) {
    plan.periodic = false;
    begin();
    workers[0].rings_every = 300us;
    workers[0].timer.arm(at_ns(0) + 300us);
    next_cycle();
    EXPECT_EQ(engine.next_wake(), at_ns(0) + 600us) << "on its grid";
    log.lines.clear();
    clock.advance_to(at_ns(0) + 150ms);
    const Time late = clock.now();
    while (engine.next_wake() <= clock.now()) engine.run(false);
    EXPECT_EQ(log.lines, (Lines{"a rings"}));
    EXPECT_EQ(engine.next_wake(), late + 300us);
}

TEST_F(ExecutionEngine, serves_messages_between_periods_without_stepping_components) {
    begin();
    tell(1);
    engine.run(true);
    EXPECT_EQ(log.lines, (Lines{"b hears"}));
}

TEST_F(ExecutionEngine, steps_sporadic_components_when_woken_but_not_for_a_timer) {
    plan.periodic = false;
    begin();
    EXPECT_EQ(engine.next_wake(), never);
    engine.run(true);
    EXPECT_EQ(log.lines, (Lines{"a steps", "b steps"}));
    log.lines.clear();
    workers[1].timer.arm(clock.now() + 10us);
    next_cycle();
    EXPECT_EQ(log.lines, (Lines{"b rings"}));
}

TEST_F(EngineWithABehaviour, steps_a_behaviour_at_the_time_it_requested) {
    plan.periodic = false;
    begin();
    wish.at = at_ns(0) + 250us;
    EXPECT_EQ(engine.next_wake(), wish.at);
    next_cycle();
    EXPECT_EQ(log.lines, (Lines{"behaviour"}));
}

TEST_F(ExecutionEngine, times_every_function_of_every_component) {
    begin();
    workers[0].load = 20us;
    workers[1].load = 30us;
    next_cycle();
    next_cycle();
    tell(1);
    next_cycle();
    EXPECT_EQ(functions[index(0, FunctionKind::step)].passes, 3u);
    EXPECT_EQ(functions[index(0, FunctionKind::step)].longest, 20us);
    EXPECT_EQ(functions[index(1, FunctionKind::step)].usual(), 30us);
    EXPECT_EQ(functions[index(1, FunctionKind::reactions)].last, 30us);
    EXPECT_EQ(functions[index(0, FunctionKind::reactions)].passes, 0u);
    EXPECT_EQ(statistics().longest_busy, 80us);
    EXPECT_EQ(statistics().misses, 0u);
}

TEST_F(ExecutionEngine, blames_a_missed_deadline_on_the_function_that_exceeded_its_usual_time) {
    plan.deadline = 200us;
    workers[0].load = 100us; // always slow: not the cause
    workers[1].load = 10us;
    begin();
    for (int i = 0; i < 5; ++i) next_cycle();
    ASSERT_EQ(statistics().misses, 0u);
    workers[1].load = 150us;
    next_cycle();
    ASSERT_EQ(statistics().misses, 1u);
    EXPECT_EQ(last_miss().function, index(1, FunctionKind::step));
    EXPECT_EQ(last_miss().response, 250us);
    EXPECT_EQ(last_miss().took, 150us);
    EXPECT_EQ(last_miss().usual, 10us);
    EXPECT_EQ(last_miss().release, at_ns(0) + 6 * period);
    EXPECT_EQ(functions[index(1, FunctionKind::step)].blamed, 1u);
    EXPECT_EQ(functions[index(0, FunctionKind::step)].blamed, 0u);
    EXPECT_TRUE(stops.empty()) << "counted, unless the row says stop_when_late";
}

TEST_F(ExecutionEngine, blames_no_function_when_the_cycle_began_late) {
    plan.deadline = 200us;
    workers[0].load = 10us;
    begin();
    for (int i = 0; i < 3; ++i) next_cycle();
    clock.advance_to(engine.next_wake() + 300us);
    engine.run(false);
    ASSERT_EQ(statistics().misses, 1u);
    EXPECT_EQ(last_miss().function, Miss::nobody);
    EXPECT_EQ(last_miss().took, 300us);
    EXPECT_EQ(statistics().longest_lateness, 300us);
    for (const FunctionTiming& each : functions) EXPECT_EQ(each.blamed, 0u);
}

TEST_F(ExecutionEngine, blames_a_slow_reaction_like_a_slow_step) {
    plan.deadline = 200us;
    workers[0].load = 100us;
    begin();
    for (int i = 0; i < 3; ++i) {
        tell(1);
        next_cycle();
    }
    ASSERT_EQ(statistics().misses, 0u);
    tell(1);
    workers[1].reaction_load = 130us;
    next_cycle();
    ASSERT_EQ(statistics().misses, 1u);
    EXPECT_EQ(last_miss().function, index(1, FunctionKind::reactions));
    EXPECT_EQ(last_miss().took, 130us);
}

TEST_F(ExecutionEngine, requests_a_stop_when_the_row_makes_late_cycles_fatal) {
    plan.deadline = 50us;
    plan.stop_when_late = true;
    begin();
    next_cycle();
    EXPECT_TRUE(stops.empty());
    workers[0].load = 60us;
    next_cycle();
    EXPECT_EQ(stops, (Stops{{StopReason::missed_deadline, index(0, FunctionKind::step)}}));
}

TEST_F(ExecutionEngine, counts_no_missed_deadlines_without_real_time) {
    plan.real_time = false;
    plan.deadline = 10us;
    workers[0].load = 500us;
    begin();
    next_cycle();
    next_cycle();
    EXPECT_EQ(statistics().misses, 0u);
}

TEST_F(ExecutionEngine, skips_and_counts_the_periods_lost_to_an_overrun) {
    begin();
    next_cycle();
    workers[0].load = 3500us;
    next_cycle(); // from 2 ms to 5.5 ms: the cycles of 3, 4 and 5 ms are lost
    EXPECT_EQ(statistics().skipped_periods, 3u);
    EXPECT_EQ(engine.next_wake(), at_ns(0) + 6 * period);
    workers[0].load = 0us;
    next_cycle();
    EXPECT_EQ(workers[0].last.release, at_ns(0) + 6 * period);
    EXPECT_EQ(statistics().skipped_periods, 3u);
}

TEST_F(ExecutionEngine, counts_wakes_above_the_rate_in_its_row) {
    plan.periodic = false;
    plan.at_most_n = 2;
    plan.at_most_per = 1ms;
    begin();
    const auto woken_at = [this](Duration when) {
        clock.advance_to(at_ns(0) + when);
        engine.run(true);
    };
    woken_at(0us);
    woken_at(100us);
    EXPECT_EQ(statistics().wakes_too_many, 0u) << "two may come together";
    woken_at(1ms); // the first wake's window has just ended
    EXPECT_EQ(statistics().wakes_too_many, 0u);
    woken_at(1050us); // the third wake within 1 ms from 100 us on
    EXPECT_EQ(statistics().wakes_too_many, 1u);
    woken_at(5ms);
    EXPECT_EQ(statistics().wakes_too_many, 1u);
}

/// A value that a writer elsewhere keeps valid for a while without a wake.
struct Aging {
    const os::Clock* clock = nullptr;
    Time good_until = never;
};
constexpr PortOperations aging_port = [] {
    PortOperations operations{};
    operations.flow = [](void* self) noexcept TAPPET_REALTIME {
        const auto& at = *static_cast<const Aging*>(self);
        return at.clock->now() <= at.good_until ? Flow::old : Flow::stale;
    };
    operations.expires = [](const void* self) noexcept
        TAPPET_REALTIME { return static_cast<const Aging*>(self)->good_until + 1ns; };
    return operations;
}();

TEST_F(ExecutionEngine, wakes_a_sporadic_activity_when_a_guarded_input_becomes_stale) {
    Aging aging{&clock, at_ns(0) + 20ms};
    std::array guarded{GuardedInput{.input = &aging, .port = &aging_port, .connection = 17, .stops = true}};
    plan.periodic = false;
    plan.at_most_n = 1;
    plan.at_most_per = 1ms;
    plan.guarded = guarded;
    begin();
    next_cycle(); // the first check, at the start
    EXPECT_EQ(engine.next_wake(), at_ns(0) + 20ms + 1ns);
    aging.good_until += 30ms; // written meanwhile
    next_cycle();
    EXPECT_TRUE(stops.empty());
    EXPECT_EQ(log.lines, Lines{}) << "nothing happened that a component could hear of";
    EXPECT_EQ(engine.next_wake(), at_ns(0) + 50ms + 1ns);
    next_cycle();
    EXPECT_EQ(stops, (Stops{{StopReason::stale_input, 17}}));
    EXPECT_EQ(log.lines, (Lines{"a steps", "b steps"})) << "that it is stale is news";
    EXPECT_EQ(engine.next_wake(), never) << "told once";
    EXPECT_EQ(statistics().wakes_too_many, 0u);
}

TEST_F(EngineWithABehaviour, serves_messages_sent_before_and_during_the_stop_of_behaviours) {
    behaviours[0].self = this;
    behaviours[0].stop = [](void* self, Time) noexcept TAPPET_REALTIME {
        auto& test = *static_cast<ExecutionEngine*>(self);
        test.log.add("behaviour stops");
        TAPPET_ESCAPE("a test asserts", test.tell(0));
    };
    behaviours[0].next = [](const void*) noexcept TAPPET_REALTIME { return never; };
    begin();
    tell(1);
    engine.stop(clock.now());
    EXPECT_EQ(log.lines, (Lines{"b hears", "behaviour stops", "a hears", "a stops", "b stops"}));
}

TEST_F(ExecutionEngine, compares_processor_time_with_the_budget_of_the_row) {
    plan.budget = 100us;
    begin();
    for (int n = 0; n < 5; ++n) next_cycle();
    EXPECT_EQ(statistics().over_claim, 0u);
    workers[0].load = 150us;
    next_cycle(); // measured from now on
    for (int n = 0; n < 3; ++n) next_cycle();
    EXPECT_EQ(statistics().over_claim, 3u);
    EXPECT_EQ(statistics().most_processor, 150us);
    workers[0].load = 90us;
    for (int n = 0; n < 3; ++n) next_cycle();
    EXPECT_EQ(statistics().over_claim, 3u);
}

TEST_F(ExecutionEngine, measures_every_claim_at_first_and_samples_later_ones) {
    plan.budget = 100us;
    workers[0].load = 150us;
    begin();
    const auto measured = [this](std::uint32_t cycles) {
        const std::uint64_t before = statistics().measured_claims;
        for (std::uint32_t n = 0; n < cycles; ++n) next_cycle();
        EXPECT_EQ(statistics().over_claim, statistics().measured_claims) << "each takes too much";
        return statistics().measured_claims - before;
    };
    EXPECT_EQ(measured(2), 0u) << "the second cycle tells that a budget is in doubt";
    EXPECT_EQ(measured(Engine::measured_at_first), Engine::measured_at_first);
    const std::uint64_t of_many = measured(100 * Engine::measured_one_of);
    EXPECT_GT(of_many, 50u);
    EXPECT_LT(of_many, 200u);
    engine.measure_as_at_first();
    EXPECT_EQ(measured(Engine::measured_at_first), Engine::measured_at_first);
}

TEST_F(ExecutionEngine, finds_periodic_overruns_of_the_budget_by_sampling) {
    plan.budget = 100us;
    begin();
    for (std::uint32_t n = 0; n < 200 * Engine::measured_one_of; ++n) {
        workers[0].load = n % (2 * Engine::measured_one_of) == 7 ? 150us : 50us;
        next_cycle();
    }
    EXPECT_GT(statistics().over_claim, 0u);
    EXPECT_EQ(statistics().most_processor, 150us);
}

TEST_F(ExecutionEngine, measures_from_the_first_wake_too_many_on) {
    begin_sporadic(1);
    workers[0].load = 90us; // within its budget
    for (int n = 1; n <= 5; ++n) {
        clock.advance_to(at_ns(0) + n * 2ms);
        engine.run(true);
    }
    workers[0].load = 80us;
    clock.advance_to(at_ns(0) + 20ms);
    for (int n = 0; n < 5000; ++n)
        engine.run(true); // back to back: 100 % of the processor, 10 % were claimed
    EXPECT_GT(statistics().wakes_too_many, 4000u);
    EXPECT_GT(statistics().measured_claims, 0u);
    EXPECT_GT(statistics().over_claim, 0u);
    EXPECT_GT(statistics().most_processor, plan.claim());
}

TEST_F(ExecutionEngine, compares_the_use_of_a_sporadic_activity_with_its_claim) {
    begin_sporadic(3);
    const auto wakes = [this](Duration first, std::initializer_list<Duration> loads) {
        clock.advance_to(at_ns(0) + first);
        for (const Duration load : loads) {
            workers[0].load = load;
            engine.run(true);
        }
    };
    wakes(1ms, {50us, 50us});
    wakes(3ms, {250us}); // measured from the next one on
    wakes(5ms, {250us, 25us, 25us});
    EXPECT_EQ(statistics().over_claim, 0u) << "three times 100 us were claimed, whoever took them";
    wakes(7ms, {250us, 25us, 26us, 100us});
    EXPECT_EQ(statistics().over_claim, 1u) << "once for one time of at_most";
    EXPECT_EQ(statistics().most_processor, 401us);
}

TEST_F(ExecutionEngine, measures_at_once_on_request_even_within_a_claim) {
    plan.budget = 100us;
    plan.periodic = false;
    plan.at_most_n = 3;
    plan.at_most_per = 10ms;
    begin();
    workers[0].load = 400us;
    for (std::uint32_t n = 0; n < Engine::measured_at_first + 3; ++n) {
        clock.advance_to(clock.now() + 10ms);
        engine.run(true);
    }
    const std::uint64_t before = statistics().over_claim;
    engine.run(true); // still within an unmeasured claim
    EXPECT_EQ(statistics().over_claim, before);
    engine.measure_as_at_first();
    engine.run(true);
    EXPECT_EQ(statistics().over_claim, before + 1);
}

TEST_F(ExecutionEngine, shows_an_even_generation_between_two_cycles) {
    begin();
    const std::uint64_t before = engine.generation();
    EXPECT_EQ(before % 2, 0u);
    next_cycle();
    EXPECT_EQ(engine.generation(), before + 2);
}

TEST_F(ExecutionEngine, keeps_its_generation_odd_while_components_run) {
    workers[0].observed = &engine;
    begin();
    tell(0);
    next_cycle();
    engine.stop(clock.now());
    engine.start(clock.now());
    EXPECT_EQ(workers[0].unguarded, std::vector<std::string>{});
    EXPECT_EQ(engine.generation() % 2, 0u);
}

TEST_F(ExecutionEngine, aligns_its_periods_to_the_common_grid_whenever_it_starts) {
    clock.advance_to(Time{} + 7'400us);
    begin();
    next_cycle();
    EXPECT_EQ(workers[0].last.release, Time{} + 8ms);
    next_cycle();
    EXPECT_EQ(workers[0].last.release, Time{} + 9ms);
}

TEST_F(ExecutionEngine, delays_its_periods_by_its_phase) {
    plan.phase = 200us;
    clock.advance_to(Time{} + 7'100us);
    begin();
    next_cycle();
    EXPECT_EQ(workers[0].last.release, Time{} + 7'200us);
    next_cycle();
    EXPECT_EQ(workers[0].last.release, Time{} + 8'200us);
}

TEST_F(ExecutionEngine, starts_all_parts_of_a_turn_or_none) {
    begin();
    engine.rest(0b10, 0b10);
    engine.leave(0b10);
    next_cycle();
    EXPECT_EQ(log.lines, (Lines{"b stops", "a steps"}));
    log.lines.clear();
    EXPECT_EQ(engine.enter(0b10).outcome, LifeOutcome::done);
    next_cycle();
    EXPECT_EQ(log.lines, (Lines{"b starts", "a steps", "b steps"}));
    parts[1].state = ComponentState::failed;
    engine.leave(0b01);
    EXPECT_EQ(engine.enter(0b11).refusal, LifeRefusal::not_initialised);
    EXPECT_EQ(parts[0].state, ComponentState::stopped) << "it had started, and waits again";
}

} // namespace
} // namespace tappet
