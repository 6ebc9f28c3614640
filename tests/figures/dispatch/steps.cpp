// Steps of engines whose components have nothing to do: the cost of the framework itself.
#include "kernel/machine/accept.hpp"
#include "tests/figures/dispatch/groups.hpp"
#include "tests/figures/measure/world.hpp"

#include <memory>

namespace tappet::figures {

namespace {

/// The smallest visible work.
struct Idle {
    std::uint64_t steps = 0;
    void step(const Cycle&) noexcept TAPPET_REALTIME { ++steps; }
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};

// ---- one component, bound by a table

constexpr auto idle_table = machine("idle", components(component<Idle>("idle")),
                                    activities(activity("motion", every(1ms), budget(50us), runs("idle"))),
                                    connections(), reactions(), behaviours());
/// As an activity does it: asks when the engine is due, waits in virtual time, runs it.
void step_without_stamps(std::size_t times) {
    static World world{os::Clock::Kind::virtual_time, AtRunTime<idle_table, figures_board>::machine()};
    Engine& engine = world.engine();
    const RunsActivity here{engine.plan().activity}; // as its thread does, once and for all
    for (std::size_t i = 0; i < times; ++i) {
        world.clock.advance_to(engine.next_wake());
        engine.run(false);
    }
}
std::uint64_t steps = 0;
[[gnu::noinline]] void step_of(void* context, const Cycle&) noexcept {
    ++*static_cast<std::uint64_t*>(context);
}
void (*volatile pointer)(void*, const Cycle&) noexcept = &step_of;
Cycle cycle;
void two_calls(std::size_t times) {
    for (std::size_t i = 0; i < times; ++i) {
        pointer(&steps, cycle);
        pointer(&steps, cycle);
    }
}

// ---- many components

/// `components` of them in activities of at most `each`.
struct Crowd {
    os::Clock clock;
    std::vector<Idle> idle;
    std::vector<EnginePart> parts;
    std::vector<FunctionTiming> functions;
    std::vector<Engine> engines;

    Crowd(os::Clock::Kind kind, std::size_t components, std::size_t each, const EnginePlan& row = {})
        : clock{kind},
          idle(components),
          parts(components),
          functions(components * functions_per_part),
          engines((components + each - 1) / each) {
        for (std::size_t i = 0; i < components; ++i) {
            parts[i].place(&idle[i]);
            parts[i].type = &component_type<Idle>;
        }
        for (std::size_t e = 0; e < engines.size(); ++e) {
            const std::size_t first = e * each, count = std::min(each, components - first);
            EnginePlan plan = row;
            plan.name = "crowd";
            plan.activity = static_cast<std::uint32_t>(e);
            plan.deadline = 1s;
            plan.parts = std::span{parts}.subspan(first, count);
            plan.functions =
                std::span{functions}.subspan(first * functions_per_part, count * functions_per_part);
            engines[e].place(plan, clock);
            engines[e].start(clock.now());
        }
    }
    void cycle() {
        for (Engine& engine : engines) engine.run(true);
    }
};
template <os::Clock::Kind kind, std::size_t components, std::size_t each>
void step_crowd(std::size_t times) {
    static Crowd crowd{kind, components, each};
    for (std::size_t i = 0; i < times; i += components) crowd.cycle();
}
template <std::size_t components>
void call_crowd(std::size_t times) {
    struct Entry {
        void (*function)(void*, const Cycle&) noexcept;
        void* context;
    };
    static std::vector<std::uint64_t> counts(components);
    static std::vector<Entry> entries = [] {
        std::vector<Entry> filled;
        for (std::uint64_t& each : counts) filled.push_back({&step_of, &each});
        return filled;
    }();
    for (std::size_t i = 0; i < times; i += components) {
        clobber();
        for (const Entry& entry : entries) entry.function(entry.context, cycle);
    }
}

/// One of them in real time, woken without waiting for its period.
template <const EnginePlan& row>
void step_with_stamps(std::size_t times) {
    static Crowd crowd{os::Clock::Kind::real, 1, 1, row};
    Engine& engine = crowd.engines.front();
    const RunsActivity here{engine.plan().activity};
    for (std::size_t i = 0; i < times; ++i) {
        Time next = engine.next_wake();
        keep(next);
        engine.run(true);
    }
}
constexpr EnginePlan plan_of(Duration budget, Duration at_most_per) {
    EnginePlan plan;
    plan.budget = budget;
    plan.at_most_n = 4;
    plan.at_most_per = at_most_per;
    return plan;
}
constexpr EnginePlan plain = plan_of(0ns, 0ns), promised = plan_of(0ns, 1ms), over_budget = plan_of(1ns, 1us);

constexpr auto without = os::Clock::Kind::virtual_time;
constexpr auto with = os::Clock::Kind::real;

template <std::size_t components>
Group crowd_of(std::string name) {
    return {
        "dispatch.step." + name,
        "engine time for one of " + name + " components",
        "thesis 5.3",
        components,
        {{"one activity, time stamps excluded", Standing::ours, &step_crowd<without, components, components>},
         {"activities of ten, time stamps excluded", Standing::ours, &step_crowd<without, components, 10>},
         {"one activity, with its time stamps", Standing::ours, &step_crowd<with, components, components>},
         {"loop over function pointers", Standing::floor, &call_crowd<components>}}};
}

} // namespace

void add_steps(std::vector<Group>& groups) {
    constexpr const char* with_stamps = "step, with its two time stamps";
    groups.push_back(
        {"dispatch.step.empty",
         "a complete engine step of one component without pending work",
         "thesis 5.3",
         64,
         {{"step, time stamps excluded", Standing::ours, &step_without_stamps},
          {with_stamps, Standing::ours, &step_with_stamps<plain>},
          {"step, with its two time stamps and at_most", Standing::ours, &step_with_stamps<promised>},
          {"step, with its two time stamps, after one over its budget", Standing::ours,
           &step_with_stamps<over_budget>},
          {"two calls through a function pointer", Standing::floor, &two_calls},
          {"two readings of the clock", Standing::floor, &read_clock<2>}}});
    groups.back().goals.push_back(
        {"empty cycle with its time stamps <= 0.3 x two readings of the clock (13 ns where they take 44)",
         with_stamps,
         0.3,
         {"two readings of the clock"}});
    groups.back().goals.push_back(
        {"empty engine step of a component without pending work, time stamps excluded and shown "
         "beside it <= 2 function-pointer calls",
         "step, time stamps excluded",
         1.0,
         {"two calls through a function pointer"}});
    groups.push_back(crowd_of<10>("10"));
    groups.push_back(crowd_of<100>("100"));
    groups.push_back(crowd_of<1000>("1000"));
}

} // namespace tappet::figures
