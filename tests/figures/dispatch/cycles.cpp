// Cycles of an engine whose component has a state machine: nothing happens, or one event. Loaded: the
// script's tables in memory.
#include "kernel/machine/accept.hpp"
#include "tests/figures/behaviour/steps.hpp"
#include "tests/figures/dispatch/groups.hpp"
#include "tests/figures/dispatch/world.hpp"

namespace tappet::figures {

namespace {

template <class... Options>
constexpr auto swing_machine(const Options&... options) {
    return machine(
        "swing", components(component<Swing>("swing")),
        activities(activity("motion", on_work(), not_real_time, runs("swing"))), connections(), reactions(),
        behaviours(behaviour("swing", swing_script, std::span<const BehaviourCode>{}, options...)));
}
constexpr auto automatic_table = swing_machine();
constexpr auto reactive_table = swing_machine(reactive_mode);
template <const auto& table> World& world_of() {
    static World world{os::Clock::Kind::real, AtRunTime<table, figures_board>::machine()};
    return world;
}

template <const auto& table>
void idle(std::size_t times) {
    World& world = world_of<table>();
    const RunsActivity here{0};
    for (std::size_t i = 0; i < times; ++i) world.engine().run(true);
}
template <const auto& table>
void event(std::size_t times) {
    World& world = world_of<table>();
    const RunsActivity here{0};
    auto& swing = *world.instance.find<Swing>("swing");
    for (std::size_t i = 0; i < times; ++i) {
        swing.beat.emit();
        world.engine().run(true);
    }
}
void reading(std::size_t times) {
    for (std::size_t i = 0; i < times; ++i) {
        Time now = os::Clock::monotonic();
        keep(now);
    }
}
void stamp(std::size_t times) {
    static os::Clock clock{os::Clock::Kind::real};
    os::Stamps stamps;
    stamps.place(clock);
    for (std::size_t i = 0; i < times; ++i) {
        Time now = stamps.now();
        keep(now);
    }
}

} // namespace

void add_cycles(std::vector<Group>& groups, std::vector<RatioGoal>& goals) {
    constexpr const char *clock = "a reading of the clock", *automatic = "automatic",
                         *is_reactive = "reactive";
    static_cast<void>(os::prove_processor_counter());
    groups.push_back({"dispatch.cycle.stamp",
                      "a time stamp of an engine",
                      "thesis A.2",
                      64,
                      {{"stamp", Standing::ours, &stamp}, {clock, Standing::floor, &reading}}});
    groups.push_back({"dispatch.cycle.idle",
                      "a cycle with a loaded state machine in which nothing happens",
                      "thesis 5.3",
                      64,
                      {{automatic, Standing::ours, &idle<automatic_table>},
                       {is_reactive, Standing::ours, &idle<reactive_table>},
                       {clock, Standing::floor, &reading}}});
    groups.push_back({"dispatch.cycle.event",
                      "an event to a loaded state machine, and the cycle after it",
                      "thesis 5.3",
                      64,
                      {{automatic, Standing::ours, &event<automatic_table>},
                       {is_reactive, Standing::ours, &event<reactive_table>},
                       {clock, Standing::floor, &reading}}});
    const auto goal = [&](const char* what, const char* where, const char* which, double most) {
        goals.push_back({what, where, which, most, {clock}});
    };
    goal(
        "idle cycle with a loaded machine, automatic <= 1.5 readings of the clock (33 ns where one takes 22)",
        "dispatch.cycle.idle", automatic, 1.5);
    goal("idle cycle with a loaded machine, reactive <= 1.36 readings of the clock (30 ns)",
         "dispatch.cycle.idle", is_reactive, 1.36);
    goal("event and cycle with a loaded script <= 6.8 readings of the clock (150 ns)", "dispatch.cycle.event",
         automatic, 6.8);
}

} // namespace tappet::figures
