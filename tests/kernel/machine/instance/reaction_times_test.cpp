// Reaction times from an edge to its effect: each row that notifies or wakes counts and measures them, in
// virtual time to the nanosecond.
#include "tests/kernel/machine/virtual_rig.hpp"

namespace tappet {
namespace {

/// A driver: accepts one edge when the test wants it.
struct Lines {
    Event<Time> rises;
    Output<bool> level;
    Time edge = never; ///< its stamp
    bool no_edge = false;
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        if (no_edge) rises.emit(Time{});
        no_edge = false;
        if (edge == never) return;
        const CausedBy here{edge};
        level.write(true, edge);
        rises.emit(edge);
        edge = never;
    }
    static constexpr auto interface() {
        return facets(event<&Lines::rises>("rises", "an edge"),
                      output<&Lines::level>("level", "", "after it", stamps_cause));
    }
};

/// Uses some time, then notifies another component.
struct Logic : Clocked {
    Event<> halts;
    Input<bool> level;
    Duration load{};
    int woken = 0;
    void on_rise(Time) noexcept TAPPET_REALTIME {
        clock->consume(load);
        halts.emit();
    }
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        bool value = false;
        woken += level.read(value) == Flow::fresh;
    }
    static constexpr auto interface() {
        return facets(event<&Logic::halts>("halts", "what follows"),
                      input<&Logic::level>("level", "", "seen"),
                      operation<&Logic::on_rise>("on_rise", "takes its time"));
    }
};

struct Brake : Clocked {
    Duration load{};
    int set_times = 0;
    void set() noexcept TAPPET_REALTIME {
        ++set_times;
        clock->consume(load);
    }
    static constexpr auto interface() { return facets(operation<&Brake::set>("set", "writes the output")); }
};

// clang-format off
constexpr auto table = machine("reactions",
    components(component<Lines>("lines"), component<Logic>("logic"), component<Brake>("brake")),
    activities(
        activity("lines", every(1ms), runs("lines"), budget(50us)),
        activity("logic", on_work(), at_most(4, 1ms), runs("logic"), deadline(800us), budget(50us)),
        activity("brake", on_work(), at_most(4, 1ms), runs("brake"), deadline(500us), budget(50us))),
    connections(data("lines.level", "logic.level", wakes)),
    reactions(when("lines.rises", tell("logic.on_rise")), when("logic.halts", tell("brake.set"))),
    behaviours());
// clang-format on

constexpr std::size_t wakes_logic = 0, tells_logic = 0, tells_brake = 1; ///< rows

struct Reactions : testing::Test, RunningRig<table> {
    Lines& lines = the<Lines>("lines");
    Logic& logic = the<Logic>("logic");
    Brake& brake = the<Brake>("brake");
    Reactions() {
        logic.load = 100us;
        brake.load = 20us;
        pass(10ms);
    }
    const ReactionTimes& logic_told() { return *instance.observation().times_of_reaction(tells_logic); }
    const ReactionTimes& brake_told() { return *instance.observation().times_of_reaction(tells_brake); }
    const ReactionTimes& logic_woken() { return *instance.observation().times_of_connection(wakes_logic); }
};

TEST_F(Reactions, are_timed_from_the_edge_to_the_end_of_its_effect) {
    lines.edge = clock.now() + 700us; // the lines read it 300 us later
    pass(5ms);
    ASSERT_EQ(brake.set_times, 1);
    EXPECT_EQ(logic_told().count, 1u);
    EXPECT_EQ(brake_told().count, 1u);
    EXPECT_GE(logic_told().longest, 100us);
    EXPECT_EQ(brake_told().longest, logic_told().longest + 20us);
    EXPECT_EQ(brake_told().mean(), brake_told().longest);
    EXPECT_LT(brake_told().longest, 1ms);
}

TEST_F(Reactions, are_timed_to_the_end_of_the_cycle_that_the_row_woke) {
    const Time edge = lines.edge = clock.now();
    pass(5ms);
    EXPECT_EQ(logic.woken, 1);
    EXPECT_EQ(logic_woken().count, 1u);
    EXPECT_GE(logic_woken().longest, 100us) << "the operation ran in that cycle";
    EXPECT_LE(edge + logic_woken().longest, clock.now());
}

TEST_F(Reactions, are_counted_only_when_an_edge_caused_them) {
    lines.no_edge = true;
    pass(5ms);
    ASSERT_EQ(brake.set_times, 1);
    EXPECT_EQ(logic_told().count, 0u);
    EXPECT_EQ(brake_told().count, 0u);
    lines.edge = clock.now();
    pass(5ms);
    lines.no_edge = true;
    pass(5ms);
    EXPECT_EQ(brake.set_times, 3);
    EXPECT_EQ(brake_told().count, 1u)
        << "a later emission without an edge does not inherit the cause of an earlier one";
    EXPECT_EQ(logic_woken().count, 1u);
}

TEST_F(Reactions, are_recorded_for_each_row_separately) {
    EXPECT_NE(instance.observation().times_of_connection(wakes_logic), nullptr);
    EXPECT_NE(instance.observation().times_of_reaction(tells_logic),
              instance.observation().times_of_reaction(tells_brake));
}

// ---- through a periodic activity

/// Drives its output from what it read, or was told, before.
struct Cell {
    Input<bool> level;
    Output<bool> motor;
    bool told = false;
    void on_rise(Time) noexcept TAPPET_REALTIME { told = true; }
    void step(const Cycle&) noexcept TAPPET_REALTIME { motor.write(level.get() || told); }
    static constexpr auto interface() {
        return facets(input<&Cell::level>("level", "", "seen", optional),
                      output<&Cell::motor>("motor", "", "what follows"),
                      operation<&Cell::on_rise>("on_rise", "notes it"));
    }
};
struct Motor : Clocked {
    Input<bool> runs;
    int woken = 0;
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        ++woken;
        clock->consume(20us);
    }
    static constexpr auto interface() { return facets(input<&Motor::runs>("runs", "", "shall run")); }
};

template <class Connected, class Told> constexpr auto cell_with(const Connected& connected,
                                                                const Told& told) {
    return machine("cell",
                   components(component<Lines>("lines"), component<Cell>("cell"), component<Motor>("motor")),
                   activities(activity("lines", every(1ms), runs("lines"), budget(50us)),
                              activity("cell", every(5ms), runs("cell"), budget(50us)),
                              activity("motor", on_work(), at_most(4, 1ms), runs("motor"), deadline(500us),
                                       budget(50us))),
                   connected, told, behaviours());
}
constexpr auto reading_cell = cell_with(
    connections(data("cell.motor", "motor.runs", wakes), data("lines.level", "cell.level")), reactions());
constexpr auto told_cell = cell_with(connections(data("cell.motor", "motor.runs", wakes)),
                                     reactions(when("lines.rises", tell("cell.on_rise"))));

template <const auto& table> struct ReactionsOf : testing::Test, RunningRig<table> {
    /// Takes an edge just after a period of the cell and of the lines.
    Time edge() {
        this->pass(20ms + 100us);
        Lines& lines = this->template the<Lines>("lines");
        lines.edge = this->clock.now();
        return lines.edge;
    }
    const ReactionTimes& motor_woken() { return *this->instance.observation().times_of_connection(0); }
};
using ReactionsOfReading = ReactionsOf<reading_cell>;
using ReactionsOfTold = ReactionsOf<told_cell>;

TEST_F(ReactionsOfReading, are_timed_through_the_cycle_that_read_the_value) {
    edge();
    EXPECT_EQ(motor_woken().count, 0u) << "its period alone is no edge";
    EXPECT_GT(the<Motor>("motor").woken, 2);
    pass(50ms);
    EXPECT_EQ(motor_woken().count, 1u) << "later cycles read an old value";
    EXPECT_GE(motor_woken().longest, 5ms - 100us);
    EXPECT_LE(motor_woken().longest, 5ms);
    edge();
    pass(50ms);
    EXPECT_EQ(motor_woken().count, 2u);
}

TEST_F(ReactionsOfTold, are_timed_through_the_step_that_follows_the_message) {
    edge();
    pass(50ms);
    EXPECT_EQ(motor_woken().count, 1u);
    EXPECT_GE(motor_woken().longest, 5ms - 100us);
    EXPECT_LE(motor_woken().longest, 11ms) << "served behind one step, acted on in the next";
    edge();
    pass(50ms);
    EXPECT_EQ(motor_woken().count, 2u);
}

TEST(ReactionTimes, use_bins_of_powers_of_two_microseconds) {
    ReactionTimes times;
    for (const Duration took : {Duration{-5}, Duration{999}, Duration{1us}, Duration{1999}, Duration{2us},
                                Duration{3999}, Duration{8191us}, Duration{16384us}, Duration{10s}})
        times.add(took);
    EXPECT_EQ(times.histogram[0], 2u);
    EXPECT_EQ(times.histogram[1], 2u);
    EXPECT_EQ(times.histogram[2], 2u);
    EXPECT_EQ(times.histogram[13], 1u);
    EXPECT_EQ(times.histogram[15], 2u);
    EXPECT_EQ(times.count, 9u);
    EXPECT_EQ(times.longest, 10s);
}

} // namespace
} // namespace tappet
