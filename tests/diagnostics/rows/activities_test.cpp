// Activities: their wake-up, their functions, their schedulability, and their watchdogs.
#include "kernel/services/time/timed_event.hpp"
#include "kernel/services/time/watchdog.hpp"
#include "tests/diagnostics/rows/fault.hpp"
#include "tests/diagnostics/small_machine.hpp"

namespace {

using namespace small;
using namespace tappet::diagnostics;

struct Horn {
    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};

struct TimedHorn {
    Timer silence;
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME { silence.arm(cycle.now + 1s); }
    void off(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(timer<&TimedHorn::silence, &TimedHorn::off>("silence", "switches it off"));
    }
};

/// Emits in its step; the second also when it starts.
struct Bell {
    Event<> rung;
    void step(const Cycle&) noexcept TAPPET_REALTIME { rung.emit(); }
    void ring() noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(event<&Bell::rung>("rung", "it was heard"),
                      operation<&Bell::ring>("ring", "sounds it"));
    }
};
struct StartedBell : Bell {
    void start(const Cycle&) noexcept TAPPET_REALTIME { rung.emit(); }
};
/// Sends a command in its step, whose end wakes it.
struct Caller {
    CommandCall<int> ask;
    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() { return facets(sends<&Caller::ask>("ask", "for a ring")); }
};
struct Answerer {
    bool answer(int) noexcept TAPPET_REALTIME { return true; }
    static constexpr auto interface() { return facets(command<&Answerer::answer>("answer", "rings")); }
};
/// Serves its device once in each cycle.
struct PacedBus {
    static constexpr const DeviceKind& device_kind = can::device_kind;
    static constexpr int device_map = 0;
    static constexpr bool woken_by_device = true;
    static constexpr DevicePace device_pace{"order", 10ms};
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};

/// The rows of small_machine.hpp with other options.
void motion(Table& m, const auto&... options) {
    m.put(activity("motion", options..., runs("shaft", "tension")));
}
void logic(Table& m, const auto&... options) {
    m.put(activity("logic", on_work(), options..., runs("weft", "lamps")));
}
void hall(Table& m, const auto&... options) { m.put(activity("hall", options..., runs("climate"))); }
void field(Table& m, const auto&... options) {
    m.put(activity("field", at_most(1, 1ms), options..., runs("encoder")));
}

constexpr Fault activity_faults[] = {
    {"activity_twice",
     [](Table& m) { m.activities[3] = activity("motion", every(250ms), not_real_time, runs("climate")); },
     R"(loom: activity "motion" appears twice in activities(...), rows 2 and 4; rename or remove one)"},
    {"activity_two_triggers", [](Table& m) { motion(m, every(1ms), on_work(), budget(120us)); },
     R"(loom: activity "motion" has more than one trigger; keep one)"},
    {"activity_budget_twice", [](Table& m) { motion(m, every(1ms), budget(120us), budget(80us)); },
     R"(loom: activity "motion" has more than one budget; keep one)"},
    {"activity_runs_twice",
     [](Table& m) { m.put(activity("motion", every(1ms), budget(120us), runs("shaft"), runs("tension"))); },
     R"(loom: activity "motion" has more than one runs(...); keep one)"},
    {"activity_phase_beyond_its_period", [](Table& m) { motion(m, every(1ms, phase(1ms)), budget(120us)); },
     R"(loom: activity "motion": its phase of 1000 us does not lie within its period; write one from 0 us to below 1000 us)"},
    {"activity_runs_nothing", [](Table& m) { m.add(activity("idle", every(10ms), budget(1us))); },
     R"(loom: activity "idle" runs no component; add runs("...") or remove the row)"},
    {"activity_runs_unknown",
     [](Table& m) { m.put(activity("motion", every(1ms), budget(120us), runs("shaft", "tensoin"))); },
     R"(loom: activity "motion": there is no component "tensoin"; did you mean "tension"?)"},
    {"activity_without_trigger", [](Table& m) { motion(m, budget(120us)); },
     R"(loom: activity "motion": nothing wakes it; add every(...), on_work() or on_device("..."))"},
    {"activity_without_budget", [](Table& m) { motion(m, every(1ms)); },
     R"(loom: activity "motion" has no budget; add budget(...), or not_real_time)"},
    {"activity_without_rate", [](Table& m) { logic(m, deadline(2ms), budget(80us)); },
     R"(loom: activity "logic" does not say how often it may be woken; add at_most(n, per))"},
    {"activity_times_negative_that_nobody_asks",
     [](Table& m) { hall(m, every(250ms), not_real_time, budget(-1us)); },
     R"(loom: activity "hall": its budget is negative; correct budget(...))"},
    {"activity_window_negative", [](Table& m) { hall(m, on_work(), not_real_time, at_most(1, -1ms)); },
     R"(loom: activity "hall": the window of at_most is negative; correct at_most(n, per))"},
    {"activity_wakes_without_number",
     [](Table& m) {
         hall(m, on_work(), not_real_time, at_most(std::numeric_limits<std::int64_t>::max(), 1ms));
     },
     R"(loom: activity "hall" promises more than 32 wakes in one window; shorten the window of at_most)"},
    {"activity_runs_too_many", [](Table& m) { m.activities[1].too_many_runs = true; },
     R"(loom: activity "motion" runs more than 64 components; divide it)"},
    {"activity_that_is_never_woken",
     [](Table& m) { logic(m, at_most(0, 10ms), deadline(2ms), budget(80us)); },
     R"(loom: activity "logic": at_most needs at least one wake; write at_most(1, ...))"},
    {"activity_with_too_many_wakes",
     [](Table& m) { logic(m, at_most(33, 10ms), deadline(2ms), budget(80us)); },
     R"(loom: activity "logic" promises more than 32 wakes in one window; shorten the window of at_most)"},
    {"activity_deadline", [](Table& m) { logic(m, at_most(4, 10ms), deadline(-2ms), budget(80us)); },
     R"(loom: activity "logic": its deadline is negative; correct deadline(...))"},
    {"activity_period", [](Table& m) { motion(m, every(0ms), budget(120us)); },
     R"(loom: activity "motion": its period is not positive; write every(1ms) or the like)"},
    {"activity_stack", [](Table& m) { motion(m, every(1ms), budget(120us), stack(4096)); },
     R"(loom: activity "motion": its stack of 4096 bytes is under 16384; enlarge stack(...))"},
    {"activity_stack_of_all", [](Table& m) { motion(m, every(1ms), budget(120us), stack(~std::size_t{0})); },
     R"(loom: activity "motion": its stack of 18446744073709551615 bytes is over 1073741824; write a smaller stack(...))"},
    {"activity_blocks", [](Table& m) { hall(m, every(250ms), budget(1ms)); },
     R"(loom: activity "hall" is real-time but component "climate" may block (it has work()); run it in an activity that is not_real_time)"},
};
INSTANTIATE_TEST_SUITE_P(activities, Refusal, planted_into(small_loom, activity_faults), name_of);

constexpr Fault device_faults[] = {
    {"activity_on_device_elsewhere",
     [](Table& m) {
         m.put(activity("field", on_device("encoder"), at_most(1, 1ms), deadline(300us), budget(30us),
                        runs("lamps")));
         m.put(activity("logic", on_work(), at_most(4, 10ms), deadline(2ms), budget(80us),
                        runs("weft", "encoder")));
     },
     R"(loom: activity "field" is woken by the device of "encoder" but does not run it; add it to runs(...))"},
    {"activity_on_no_driver", [](Table& m) { field(m, on_device("shaft"), deadline(300us), budget(30us)); },
     R"(loom: activity "field": component "shaft" drives no device to wake it; name a driver in on_device(...))"},
    {"activity_on_unknown_device",
     [](Table& m) { field(m, on_device("encodre"), deadline(300us), budget(30us)); },
     R"(loom: activity "field": there is no component "encodre"; did you mean "encoder"?)"},
    {"activity_on_device_that_wakes_nobody", [](Table& m) { hall(m, on_device("climate"), not_real_time); },
     R"~(loom: activity "hall": component "climate" polls its modbus device, which wakes nobody; run it every(...), or let small::Climate say woken_by_device = true if its configure() calls Setup::woken_by())~"},
    {"driver_that_polls_when_nobody_wakes_it", [](Table& m) { hall(m, on_work(), not_real_time); },
     R"~(loom: activity "hall" runs on_work() but no row wakes it, so the work() of component "climate" would never run; add wakes to a connection into it, or when("...", tell("climate.operation")), or run it every(...))~"},
    {"driver_that_polls_when_another_is_woken",
     [](Table& m) {
         m.put(activity("field", on_device("encoder"), not_real_time, runs("encoder", "climate")));
         m.activities.pop_back();
     },
     R"~(loom: activity "field" is woken by no row but by another driver's device, and component "climate" polls its modbus device, which wakes nobody; run it every(...))~"},
    {"bus_slower_than_what_is_sent_on_demand",
     [](Table& m) { m.add(component<PacedBus>("bus", device("main_encoder")), "hall"); },
     R"~(loom: activity "hall" runs every 250000 us, but "bus.order" may cross the wire every 10000 us by its map; shorten the activity's period, or lengthen the every(...) or on_demand(...) of the map)~"},
};
INSTANTIATE_TEST_SUITE_P(devices, Refusal, planted_into(small_loom, device_faults), name_of);

template <class Type> void make_noise(Table& m) {
    m.add(component<Type>("horn"));
    m.add(activity("noise", on_work(), at_most(1, 100ms), budget(10us), runs("horn")));
}

void make_rings(Table& m, std::string_view first, std::string_view second) {
    m.add(component<Bell>("left"));
    m.add(component<Bell>("right"));
    m.add(activity("left", on_work(), at_most(1, 100ms), budget(10us), runs("left")));
    m.add(activity("right", on_work(), at_most(1, 100ms), budget(10us), runs("right")));
    m.add(when("left.rung", tell(first)));
    m.add(when("right.rung", tell(second)));
}

constexpr Fault work_faults[] = {
    {"activity_that_only_its_own_step_wakes",
     [](Table& m) {
         make_noise<Bell>(m);
         m.add(when("horn.rung", tell("horn.ring")));
     },
     R"~(loom: activity "noise" runs on_work() but is woken only by what never runs itself, first by "horn.rung" -> "horn.ring", so the step() of component "horn" would never run; add wakes or tell(...) from a component that is run every(...) or on_device(...), or run it every(...))~"},
    {"activities_that_only_wake_each_other", [](Table& m) { make_rings(m, "right.ring", "left.ring"); },
     R"~(loom: activity "left" runs on_work() but is woken only by what never runs itself, first by "right.rung" -> "left.ring", so the step() of component "left" would never run; add wakes or tell(...) from a component that is run every(...) or on_device(...), or run it every(...))~"},
    {"activity_that_only_the_end_of_its_own_command_wakes",
     [](Table& m) {
         make_noise<Caller>(m);
         m.add(component<Answerer>("answerer"), "motion");
         m.add(uses("horn.ask", "answerer.answer"));
     },
     R"~(loom: activity "noise" runs on_work() but is woken only by what never runs itself, first by "answerer.answer" -> "horn.ask", so the step() of component "horn" would never run; add wakes or tell(...) from a component that is run every(...) or on_device(...), or run it every(...))~"},
    {"activity_that_nothing_wakes", make_noise<Horn>,
     R"(loom: activity "noise" runs on_work() but no row wakes it, so the step() of component "horn" would never run; add wakes to a connection into it, or when("...", tell("horn.operation")), or run it every(...))"},
    {"activity_that_only_a_timer_wakes", make_noise<TimedHorn>,
     R"(loom: activity "noise" runs on_work() but no row wakes it, so the step() of component "horn" would never run; add wakes to a connection into it, or when("...", tell("horn.operation")), or run it every(...))"},
    {"timer_in_a_periodic_activity", [](Table& m) { m.add(component<TimedHorn>("horn"), "motion"); },
     R"(loom: activity "motion" is periodic but component "horn" has the timer "silence", which runs between periods; run it on_work() with at_most(n, per), so that the analysis counts it)"},
};
INSTANTIATE_TEST_SUITE_P(work, Refusal, planted_into(small_loom, work_faults), name_of);

TEST(Wakes, a_start_and_a_chain_from_what_runs_itself_wake) {
    Table started = small_loom();
    make_noise<StartedBell>(started);
    started.add(when("horn.rung", tell("horn.ring")));
    EXPECT_EQ(started.refusal(), "");
    Table chain = small_loom();
    make_rings(chain, "right.ring", "left.ring");
    chain.add(when("shaft.window", tell("left.ring")));
    EXPECT_EQ(chain.refusal(), "");
}

constexpr Fault schedule_faults[] = {
    {"activities_more_than_a_processor",
     [](Table& m) {
         m.activities[1] =
             activity("motion", every(1ms), deadline(5ms), budget(990us), runs("shaft", "tension"));
     },
     R"(loom: activity "motion" is not schedulable on processor 1 of board "bench": the activities there need more than all of its time; lower budgets, lengthen periods, or place it elsewhere)"},
    {"activity_budget_over_deadline",
     [](Table& m) { field(m, on_device("encoder"), deadline(20us), budget(30us)); },
     R"(loom: activity "field": its budget is 30 us but its deadline 20 us; lower the budget or lengthen the deadline or the period)"},
    {"activity_budget_that_wraps", [](Table& m) { logic(m, at_most(4, 10ms), budget(Duration{1LL << 62})); },
     R"(loom: activity "logic": its budget, for all wakes that may come together, is 9223372036854775 us but its deadline 10000 us; lower the budget or lengthen the deadline or the period)"},
    {"activity_not_schedulable", [](Table& m) { logic(m, at_most(4, 10ms), deadline(340us), budget(80us)); },
     R"(loom: activity "logic" is not schedulable on processor 1 of board "bench": its worst response is 350 us, its deadline 340 us; lower the budget of it or of a more urgent activity, lengthen its deadline, or place it elsewhere)"},
    {"board_stop_too_short", [](Table& m) { m.board.stop_within = 50ms; },
     R"(loom: board "bench": stop_within is 50 ms, but a stop may take 137 ms: 13 ms until it begins, 5 ms for two responses of each real-time activity, 100 ms for the ends of behaviours, 20 ms for what may block; write stop_within = 167ms into the board, or shorten deadlines)"},
};
INSTANTIATE_TEST_SUITE_P(schedules, Refusal, planted_into(small_loom, schedule_faults), name_of);

// ---- watchdogs

Table guarded_loom() {
    Table m = small_loom();
    m.add(component<Watchdog>("dog", watches("motion"), set("limit", 20ms)));
    m.add(activity("kennel", every(10ms), not_real_time, runs("dog")));
    return m;
}

constexpr Fault watch_faults[] = {
    {"watch_of_nothing", [](Table& m) { m.put(component<Watchdog>("dog")); },
     R"(loom: component "dog" watches nothing; add watches("...") with an activity or an output)"},
    {"watch_of_an_unknown_name",
     [](Table& m) { m.put(component<Watchdog>("dog", watches("thunder"), set("limit", 20ms))); },
     R"(loom: component "dog" watches "thunder", but no activity has this name; name an activity, or an output as component.output)"},
    {"watch_by_another", [](Table& m) { m.put(component<TimedEvent>("dog", watches("motion"))); },
     R"(loom: component "dog" is not a watchdog; remove watches("motion"))"},
    {"watch_activity_unknown",
     [](Table& m) { m.put(component<Watchdog>("dog", watches("moton"), set("limit", 20ms))); },
     R"(loom: component "dog" watches "moton", but no activity has this name; did you mean "motion"?)"},
    {"watch_output_unknown",
     [](Table& m) { m.put(component<Watchdog>("dog", watches("encoder.angel"), set("limit", 20ms))); },
     R"(loom: component "dog" watches "encoder.angel": component "encoder" has no output "angel"; did you mean "angle"?)"},
    {"watch_of_an_event",
     [](Table& m) { m.put(component<Watchdog>("dog", watches("weft.broken"), set("limit", 20ms))); },
     R"(loom: component "dog" watches "weft.broken", which is an event; name an activity, or an output of last values)"},
    {"watch_without_a_connection",
     [](Table& m) { m.put(component<Watchdog>("dog", watches("shaft.speed"), set("limit", 20ms))); },
     R"(loom: component "dog" watches "shaft.speed", which no connection carries to another activity; connect it there, or watch activity "motion")"},
    {"watch_limit_too_short",
     [](Table& m) { m.put(component<Watchdog>("dog", watches("hall"), set("limit", 200ms))); },
     R"(loom: component "dog" watches activity "hall" with a limit of 200000 us, not longer than its period of 250000 us; lengthen the limit)"},
    {"watch_in_the_watched",
     [](Table& m) {
         m.put(activity("motion", every(1ms), budget(120us), runs("shaft", "tension", "dog")));
         m.activities.pop_back();
     },
     R"(loom: component "dog" runs in activity "motion", which it watches, and would fall silent with it; run it in another activity)"},
    {"watch_that_may_sleep",
     [](Table& m) { m.put(activity("kennel", on_work(), not_real_time, runs("dog"))); },
     R"(loom: component "dog" checks once in each cycle, but activity "kennel" may never be woken; run it in a periodic activity, every(...))"},
};
INSTANTIATE_TEST_SUITE_P(watches, Refusal, planted_into(guarded_loom, watch_faults), name_of);

} // namespace
