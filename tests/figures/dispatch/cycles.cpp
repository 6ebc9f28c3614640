// Cycles of an engine whose component has a state machine, without an event and with one. "Loaded": the
// script's tables in memory.
#include "kernel/machine/accept.hpp"
#include "tests/figures/behaviour/steps.hpp"
#include "tests/figures/dispatch/groups.hpp"
#include "tests/figures/measure/world.hpp"

namespace tappet::figures {

namespace {

template <class... Options>
constexpr auto swing_machine(const Options&... options) {
    return machine(
        "swing", components(component<Swing>("swing")),
        activities(activity("motion", on_work(), not_real_time, runs("swing"))), connections(), reactions(),
        behaviours(behaviour("swing", swing_script, std::span<const BehaviourCode>{}, options...)));
}
constexpr Slot room = slot(nodes(64), data_bytes(64), depth(2), timers(2), events("swing.beat"));
constexpr auto automatic_table = swing_machine();
constexpr auto reactive_table = swing_machine(reactive_mode);
constexpr auto automatic_slot_table = swing_machine(room);
constexpr auto reactive_slot_table = swing_machine(room, reactive_mode);
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

void add_cycles(std::vector<Group>& groups) {
    constexpr const char *clock = "a reading of the clock", *automatic = "automatic",
                         *is_reactive = "reactive", *in_slot = "automatic, in a slot",
                         *is_reactive_in_slot = "reactive, in a slot";
    groups.push_back({"dispatch.cycle.stamp",
                      "a time stamp of an engine",
                      "thesis A.2",
                      64,
                      {{"stamp", Standing::ours, &stamp}, {clock, Standing::floor, &read_clock<1>}}});
    groups.push_back(
        {"dispatch.cycle.idle",
         "a cycle with a loaded state machine in which nothing happens",
         "thesis 5.3",
         64,
         {{automatic, Standing::ours, &idle<automatic_table>},
          {is_reactive, Standing::ours, &idle<reactive_table>},
          {in_slot, Standing::ours, &idle<automatic_slot_table>},
          {is_reactive_in_slot, Standing::ours, &idle<reactive_slot_table>},
          {clock, Standing::floor, &read_clock<1>}},
         {{"idle cycle with a loaded machine, automatic <= 1.5 readings of the clock (33 ns "
           "where one takes 22)",
           automatic,
           1.5,
           {clock}},
          {"idle cycle with a loaded machine, reactive <= 1.36 readings of the clock (30 ns)",
           is_reactive,
           1.36,
           {clock}},
          {"the same in a slot, automatic <= 2.05 readings of the clock (45 ns)", in_slot, 2.05, {clock}},
          {"the same in a slot, reactive <= 0.77 readings of the clock (17 ns)",
           is_reactive_in_slot,
           0.77,
           {clock}}}});
    groups.push_back({"dispatch.cycle.event",
                      "an event to a loaded state machine, and the cycle after it",
                      "thesis 5.3",
                      64,
                      {{automatic, Standing::ours, &event<automatic_table>},
                       {is_reactive, Standing::ours, &event<reactive_table>},
                       {clock, Standing::floor, &read_clock<1>}},
                      {{"event and cycle with a loaded script <= 6.8 readings of the clock (150 ns)",
                        automatic,
                        6.8,
                        {clock}}}});
}

} // namespace tappet::figures
