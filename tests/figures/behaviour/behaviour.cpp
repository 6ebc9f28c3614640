// The cost of an event, a step, a condition, a time-out and a statement: written by hand, as a C++ table, as
// a script compiled with the firmware, as a script loaded at run time, and in Boost's libraries.
#include "tests/figures/behaviour/by_hand.hpp"
#include "tests/figures/behaviour/peers.hpp"
#include "tests/figures/behaviour/steps.hpp"
#include "tests/figures/measure/candidates.hpp"

#include "kernel/base/random.hpp"

#include <iostream>

namespace {

using namespace tappet;
using namespace tappet::figures;

// ---- events

constexpr std::size_t many_events = 65536; // more than a branch predictor can learn
std::array<std::uint8_t, many_events> random_events{};
constexpr std::array<std::uint8_t, 12> steady_events{power,  start, pick,  faster, pick,  slower,
                                                     faster, stop,  start, broken, reset, power};

struct Any {
    static constexpr int peer = 0;
    static std::size_t at(std::size_t i) { return random_events[i % many_events]; }
};
struct Steady {
    static constexpr int peer = 1;
    static std::size_t at(std::size_t i) { return steady_events[i % steady_events.size()]; }
};

/// Each candidate has its own copy of each machine, and its own position in the events.
template <class Events, class Form>
void drive(std::size_t times) {
    static Form form;
    static std::size_t place = 0;
    for (std::size_t i = 0; i < times; ++i, ++place)
        form.event(Events::at(place), at_ns(std::int64_t(place)));
}

template <Records records> struct ByHand {
    HandLoom<records> loom;
    void event(std::size_t event, Time now) { static_cast<void>(loom.dispatch(event, now)); }
    [[nodiscard]] LoomCounts counts() const { return loom.counts; }
};
constexpr std::array<std::string_view, loom_events> event_names{"power", "start", "faster", "slower",
                                                                "stop",  "pick",  "broken", "reset"};
template <const auto& source, Form form> struct Ours {
    static_assert(std::ranges::equal(native::resolved_type<source, 0>.view().triggers, event_names),
                  "the events have the same numbers in all forms");
    Bound<Loom, source, form> bound;
    void event(std::size_t event, Time now) { static_cast<void>(bound.machine.dispatch(event, now)); }
    [[nodiscard]] LoomCounts counts() const {
        if constexpr (&source == static_cast<const void*>(&loom_table)) return bound.component.counts;
        return {bound.template variable<std::int64_t>("exits"),
                bound.template variable<std::int64_t>("entries"),
                bound.template variable<std::int64_t>("picks")};
    }
};
template <void (*dispatch)(std::size_t), const LoomCounts& counted> struct Peer {
    void event(std::size_t event, Time) { dispatch(event); }
    [[nodiscard]] LoomCounts counts() const { return counted; }
};

using Bare = ByHand<Records::none>;
using Kept = ByHand<Records::kept>;
using TableCompiled = Ours<loom_table, Form::compiled>;
using TableLoaded = Ours<loom_table, Form::loaded>;
using ScriptCompiled = Ours<loom_script, Form::compiled>;
using ScriptLoaded = Ours<loom_script, Form::loaded>;
template <int number> using Msm = Peer<&msm_dispatch<number>, msm_counts>;
template <int number> using Statechart = Peer<&statechart_dispatch<number>, statechart_counts>;

/// The counts of a form after the first events.
template <class Form>
LoomCounts counted() {
    Form form;
    for (std::size_t i = 0; i < 5000; ++i) form.event(Any::at(i), at_ns(std::int64_t(i)));
    return form.counts();
}
/// Returns a difference between the forms; empty: all do the same.
std::string differs() {
    const LoomCounts right = counted<Bare>();
    const std::pair<const char*, LoomCounts> forms[] = {
        {"switch with records", counted<Kept>()},      {"table, compiled", counted<TableCompiled>()},
        {"table, loaded", counted<TableLoaded>()},     {"script, compiled", counted<ScriptCompiled>()},
        {"script, loaded", counted<ScriptLoaded>()},   {"Boost.MSM", counted<Msm<0>>()},
        {"Boost.Statechart", counted<Statechart<0>>()}};
    for (const auto& [name, counts] : forms)
        if (counts.exits != right.exits || counts.entries != right.entries || counts.picks != right.picks)
            return std::string{name} + " counts " + std::to_string(counts.exits) + " exits, " +
                   std::to_string(counts.entries) + " entries, " + std::to_string(counts.picks) +
                   " picks; the switch " + std::to_string(right.exits) + ", " +
                   std::to_string(right.entries) + ", " + std::to_string(right.picks);
    return {};
}

constexpr const char *bare = "switch by hand", *kept = "switch by hand that keeps the same records",
                     *table_compiled = "C++ table, compiled", *script_compiled = "script, compiled",
                     *script_loaded = "script, loaded", *table_loaded = "C++ table, loaded",
                     *msm = "Boost.MSM", *statechart = "Boost.Statechart";

template <class Events>
std::vector<Candidate> event_forms() {
    return {{bare, Standing::floor, &drive<Events, Bare>},
            {kept, Standing::floor, &drive<Events, Kept>},
            {table_compiled, Standing::ours, &drive<Events, TableCompiled>},
            {script_compiled, Standing::ours, &drive<Events, ScriptCompiled>},
            {script_loaded, Standing::ours, &drive<Events, ScriptLoaded>},
            {table_loaded, Standing::ours, &drive<Events, TableLoaded>},
            {msm, Standing::peer, &drive<Events, Msm<Events::peer>>},
            {statechart, Standing::peer, &drive<Events, Statechart<Events::peer>>}};
}

// ---- steps

template <class Machine, std::int64_t period>
void step_by_hand(std::size_t times) {
    static Machine machine;
    static std::int64_t now = 0;
    for (std::size_t i = 0; i < times; ++i) {
        machine.step(at_ns(now += period));
        clobber();
    }
}
template <const auto& source, Form form, std::int64_t period>
void step_ours(std::size_t times) {
    static Bound<Swing, source, form> bound;
    static std::int64_t now = 0;
    for (std::size_t i = 0; i < times; ++i) {
        bound.machine.step(at_ns(now += period));
        clobber();
    }
}
template <class ByHand, const auto& table, const auto& script, std::int64_t period>
std::vector<Candidate> step_forms() {
    return {{kept, Standing::floor, &step_by_hand<ByHand, period>},
            {table_compiled, Standing::ours, &step_ours<table, Form::compiled, period>},
            {script_compiled, Standing::ours, &step_ours<script, Form::compiled, period>},
            {script_loaded, Standing::ours, &step_ours<script, Form::loaded, period>},
            {table_loaded, Standing::ours, &step_ours<table, Form::loaded, period>}};
}
constexpr std::int64_t millisecond = 1'000'000;

// ---- statements

void sums_by_hand(std::size_t times) {
    for (std::size_t i = 0; i < times; i += statements_of_sums) {
        HandSums sums;
        static_cast<void>(sums.run());
        keep(sums);
    }
}
void run_sums(std::size_t times, const ProgramCode& code) {
    constexpr std::size_t bytes = tables_of(sums_script, 0).layout.size;
    alignas(data_alignment) static std::array<std::byte, bytes> data{};
    const ProgramTables& tables = tables_of(sums_script, 0);
    for (std::size_t i = 0; i < times; i += statements_of_sums) {
        std::ranges::copy(tables.image, data.begin());
        ProgramContext context;
        context.data = data.data();
        context.position.node = tables.programs[0].first;
        std::uint32_t statements = 20'000;
        static_cast<void>(code.run(tables, context, statements));
        keep(data);
    }
}
void sums_compiled(std::size_t times) { run_sums(times, native_code<sums_script>); }
void sums_loaded(std::size_t times) { run_sums(times, interpreted(tables_of(sums_script, 0))); }

} // namespace

int main(int argc, char** argv) {
    const Options options = read_options(argc, argv);
    tappet::Random random{20};
    for (std::uint8_t& event : random_events) event = static_cast<std::uint8_t>(random.below(loom_events));
    msm_start();
    statechart_start();
    if (const std::string why = differs(); !why.empty()) {
        std::cerr << why << '\n';
        return 1;
    }

    const std::string event =
        "state-machine event, compiled, random events, hierarchical machine of 7 states "
        "and 8 events: ";
    const std::vector<Group> groups{
        {"behaviour.event.random",
         "an event, random, to a hierarchical machine of 7 states and 8 events",
         "thesis 5.2",
         64,
         event_forms<Any>(),
         {{event + "C++ table <= 1.5 x a hand-written switch that keeps the same records",
           table_compiled,
           1.5,
           {kept}},
          {event + "script <= 1.5 x a hand-written switch that keeps the same records",
           script_compiled,
           1.5,
           {kept}},
          {event + "C++ table faster than boost msm", table_compiled, 1, {msm}},
          {event + "script faster than boost msm", script_compiled, 1, {msm}}}},
        {"behaviour.event.steady", "an event of one steady cycle, to the same machine", "thesis 5.2", 64,
         event_forms<Steady>()},
        {"behaviour.step", "a step: run program, and a condition that does not hold", "thesis 5.2.2", 64,
         step_forms<HandSwing, swing_table, swing_script, 1>()},
        {"behaviour.condition", "a step with a transition by condition, and the handle program after it",
         "thesis 5.2.2", 64, step_forms<HandRelay, relay_table, relay_script, 1>()},
        {"behaviour.timeout", "a step with a transition by time-out", "thesis 5.2.2", 64,
         step_forms<HandClock, clock_table, clock_script, millisecond>()},
        {"behaviour.statement",
         "a statement of a program, in a loop",
         "thesis 5.1",
         statements_of_sums,
         {{kept, Standing::floor, &sums_by_hand},
          {script_compiled, Standing::ours, &sums_compiled},
          {script_loaded, Standing::ours, &sums_loaded}},
         {{"a statement of a compiled script <= 1.7 x the same by hand", script_compiled, 1.7, {kept}}}}};
    figures::Result result{.program = "behaviour"};
    run_candidates(options, argv, groups, result);
    return finish(options, result);
}
