// Methods and commands through a machine's table (thesis 4.5): methods run in the caller, commands in the
// receiver's engine. A command goes through its states, returns results, and can be rejected, wrapped and
// handed on.
#include "kernel/machine/plan/operations.hpp"
#include "tests/kernel/machine/virtual_rig.hpp"

#include <gmock/gmock.h>

#include <vector>

namespace tappet {
namespace {

/// Moves one unit a cycle. Accepts one goal at a time; refuses goals beyond its track.
struct Axis {
    double position = 0.0;
    double goal = 0.0;
    bool moving = false;
    bool jams = false;
    int steps = 0;
    Notes<int> marks;              ///< arguments of mark(), in execution order
    Notes<std::string_view> order; ///< the calls of one cycle
    std::uint64_t completions_asked = 0;

    void step(const Cycle&) noexcept TAPPET_REALTIME {
        order.add("step");
        if (!moving || jams) return;
        position += goal > position ? 1.0 : -1.0;
        ++steps;
    }
    bool move_to(double to, int& taken) noexcept TAPPET_REALTIME {
        order.add("command");
        if (moving || to < 0.0 || to > 100.0) return false;
        goal = to, moving = true, steps = 0;
        taken = -1;
        return true;
    }
    CommandProgress moved_to(double to, int& taken) noexcept TAPPET_REALTIME {
        ++completions_asked;
        if (jams) {
            moving = false;
            return CommandProgress::failed;
        }
        if (position != to) return CommandProgress::executing;
        moving = false;
        taken = steps;
        return CommandProgress::done;
    }
    bool mark(int which) noexcept TAPPET_REALTIME {
        marks.add(which);
        return true;
    }
    void knock() noexcept TAPPET_REALTIME { order.add("event"); }
    double distance(double to, bool absolute) const noexcept TAPPET_REALTIME {
        const double d = to - position;
        return absolute && d < 0.0 ? -d : d;
    }
    void zero() noexcept TAPPET_REALTIME { position = 0.0; }
    static constexpr auto interface() {
        return facets(
            command<&Axis::move_to, &Axis::moved_to>("move_to", "a place on the track, in steps taken"),
            command<&Axis::mark>("mark", "noted at once"), operation<&Axis::knock>("knock", "noted"),
            method<&Axis::distance>("distance", "to a place", any_thread),
            method<&Axis::zero>("zero", "here"));
    }
};

struct Panel {
    CommandCall<double, int&> move;
    CommandCall<int> mark;
    CommandCall<int> second_mark;
    MethodCall<double(double, bool)> distance;
    MethodCall<void()> spare;
    Event<> knock;
    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(sends<&Panel::move>("move", "the axis", optional),
                      sends<&Panel::mark>("mark", "a note", optional),
                      sends<&Panel::second_mark>("second_mark", "a note", optional),
                      calls<&Panel::distance>("distance", "of the axis", optional),
                      calls<&Panel::spare>("spare", "nobody's", optional),
                      event<&Panel::knock>("knock", "a knock"));
    }
};

/// Implements its own move by the axis' move: the wrapper of a command is a command.
struct Carriage {
    CommandCall<double, int&> axis;
    bool go(double metres, int& taken) noexcept TAPPET_REALTIME {
        taken = 0;
        return axis.send(metres * 10.0);
    }
    CommandProgress gone(double, int& taken) noexcept TAPPET_REALTIME { return axis.progress(taken); }
    static constexpr auto interface() {
        return facets(command<&Carriage::go, &Carriage::gone>("go", "metres"),
                      sends<&Carriage::axis>("axis", "that carries it"));
    }
};

/// Forwards the axis' move unchanged under its own name.
struct Door {
    CommandCall<double, int&> axis;
    static constexpr auto interface() {
        return facets(forwards<&Door::axis>("go", "in units"), sends<&Door::axis>("axis", "that carries it"));
    }
};

/// Prepares a move and hands it on to a runner in another activity.
struct Planner {
    CommandCall<double, int&> move;
    Event<CommandRef<double, int&>> planned;
    void plan(double to) noexcept TAPPET_REALTIME {
        move.prepare(to);
        planned(CommandRef<double, int&>{move});
    }
    static constexpr auto interface() {
        return facets(sends<&Planner::move>("move", "handed on"),
                      event<&Planner::planned>("planned", "a move to send"));
    }
};

struct Runner {
    CommandRef<double, int&> given;
    std::uint64_t sent = 0;
    void take(CommandRef<double, int&> command) noexcept TAPPET_REALTIME {
        given = command;
        sent += given->send_prepared() ? 1u : 0u;
    }
    static constexpr auto interface() { return facets(operation<&Runner::take>("take", "and send")); }
};

// clang-format off
constexpr auto table = machine("track",
    components(component<Axis>("axis"), component<Panel>("panel"), component<Panel>("urgent"), component<Carriage>("carriage"),
               component<Planner>("planner"), component<Runner>("runner"), component<Onlooker>("watcher"),
               component<Panel>("near"), component<Door>("door")),
    activities(
        activity("motion", every(1ms),  budget(50us), runs("axis", "near", "door")),
        activity("alarm",  every(1ms),  budget(50us), deadline(500us), runs("urgent")),
        activity("panel",  every(10ms), budget(50us), runs("panel", "planner")),
        activity("logic",  on_work(), at_most(4, 1ms), deadline(5ms), budget(50us), runs("carriage", "runner")),
        activity("office", every(100ms), not_real_time, runs("watcher"))),
    connections(),
    reactions(
        uses("panel.move", "carriage.go"),
        uses("panel.mark", "axis.mark"), uses("panel.second_mark", "axis.mark"),
        uses("urgent.mark", "axis.mark"), uses("urgent.move", "axis.move_to"),
        uses("carriage.axis", "axis.move_to"), uses("door.axis", "axis.move_to"), uses("near.move", "door.go"),
        uses("planner.move", "axis.move_to", sent_by("runner")),
        uses("panel.distance", "axis.distance"), uses("near.spare", "axis.zero"),
        when("urgent.knock", tell("axis.knock")),
        when("planner.planned", tell("runner.take"))),
    behaviours());
// clang-format on
constexpr std::size_t motion = 0;

struct Rig : testing::Test, RunningRig<table> {
    Axis& axis = the<Axis>("axis");
    Panel& panel = the<Panel>("panel");
    Panel& urgent = the<Panel>("urgent");
    ~Rig() override { axis.~Axis(); } // the test's vectors; a machine's components are never destroyed
};

using Methods = Rig;
using Commands = Rig;
using CommandsDeathTest = Rig;

// ---- methods

TEST_F(Methods, run_in_the_caller_and_return_their_result) {
    axis.position = 40.0;
    EXPECT_EQ(panel.distance(30.0, false).value_or(0.0), -10.0); // no time passed: no other activity ran
    EXPECT_EQ(panel.distance(30.0, true).value_or(0.0), 10.0);
}

TEST_F(Methods, need_no_promise_inside_an_activity) {
    axis.position = 40.0;
    EXPECT_TRUE(the<Panel>("near").spare().given());
    EXPECT_EQ(axis.position, 0.0);
}

TEST_F(Methods, report_an_optional_call_without_a_row) {
    EXPECT_FALSE(panel.spare.connected());
    EXPECT_TRUE(panel.distance.connected());
}

TEST_F(Methods, accept_packed_bytes_from_an_untyped_caller) {
    axis.position = 40.0;
    const auto& facet = facet_at(instance.machine().table,
                                 {0, find_facet(instance.machine().table.components[0], "distance")});
    ASSERT_EQ(facet.method->argument_bytes, sizeof(double) + sizeof(bool));
    ASSERT_EQ(facet.method->result, type_id<double>);
    std::array<std::byte, sizeof(double) + sizeof(bool)> arguments{};
    detail::store_packed(arguments.data(), 25.0);
    detail::store_packed(arguments.data() + sizeof(double), true);
    std::array<std::byte, sizeof(double)> result{};
    ASSERT_TRUE(
        facet.method->call_packed(*instance.gate_of(0), Entry::at_once, arguments.data(), result.data()));
    EXPECT_EQ(detail::load_packed<double>(result.data()), 15.0);
}

TEST_F(Methods, run_in_their_own_engine_for_a_component_that_sees_the_machine) {
    axis.position = 40.0;
    const MachineView& seen = instance.machine().table;
    const End zero{0, find_facet(seen.components[0], "zero")};
    const End distance{0, find_facet(seen.components[0], "distance")};
    MethodRequest request;
    ASSERT_TRUE(instance.requests().request_method(zero, request, {}));
    EXPECT_FALSE(request.done());
    EXPECT_FALSE(instance.requests().request_method(zero, request, {}));
    EXPECT_EQ(axis.position, 40.0); // never in the caller
    pass(1ms);
    EXPECT_TRUE(request.done());
    EXPECT_EQ(axis.position, 0.0);
    std::array<std::byte, 17> values{};
    detail::store_packed(values.data(), -3.0);
    detail::store_packed(values.data() + 8, true);
    EXPECT_FALSE(instance.requests().request_method(distance, request, std::span{values}.first(16)));
    ASSERT_TRUE(instance.requests().request_method(distance, request, values));
    pass(1ms);
    EXPECT_EQ(detail::load_packed<double>(values.data() + 9), 3.0);
    EXPECT_FALSE(
        instance.requests().request_method({0, find_facet(seen.components[0], "move_to")}, request, values));
}

// ---- the life of a command

TEST_F(Commands, go_through_their_states_and_return_results) {
    EXPECT_EQ(urgent.move.state(), CommandState::ready);
    ASSERT_TRUE(urgent.move.send(3.0));
    EXPECT_EQ(urgent.move.state(), CommandState::sent);
    EXPECT_FALSE(axis.moving); // not in the sender
    pass(1ms);
    EXPECT_EQ(urgent.move.state(), CommandState::executing);
    pass(2ms);
    EXPECT_EQ(urgent.move.state(), CommandState::executing);
    pass(1ms);
    EXPECT_EQ(urgent.move.state(), CommandState::done);
    EXPECT_EQ(urgent.move.result(), 3);
    EXPECT_EQ(axis.position, 3.0);
    const std::uint64_t asked = axis.completions_asked;
    pass(10ms);
    EXPECT_EQ(axis.completions_asked, asked); // an ended command is not queried again
}

TEST_F(Commands, are_rejected_when_the_action_refuses) {
    ASSERT_TRUE(urgent.move.send(101.0));
    pass(2ms);
    EXPECT_EQ(urgent.move.state(), CommandState::rejected);
    EXPECT_EQ(axis.completions_asked, 0u);
}

TEST_F(Commands, fail_when_they_cannot_be_completed) {
    ASSERT_TRUE(urgent.move.send(50.0));
    pass(5ms);
    axis.jams = true;
    pass(1ms);
    EXPECT_EQ(urgent.move.state(), CommandState::failed);
}

TEST_F(Commands, cannot_be_sent_again_or_reset_while_pending) {
    ASSERT_TRUE(urgent.move.send(5.0));
    EXPECT_FALSE(urgent.move.send(6.0));
    EXPECT_FALSE(urgent.move.reset());
    pass(2ms);
    EXPECT_FALSE(urgent.move.send(6.0));
    EXPECT_FALSE(urgent.move.reset());
    pass(10ms);
    EXPECT_EQ(axis.position, 5.0); // by the first arguments
    EXPECT_TRUE(urgent.move.reset());
    EXPECT_EQ(urgent.move.state(), CommandState::ready);
    EXPECT_TRUE(urgent.move.send(6.0));
    pass(3ms);
    EXPECT_EQ(urgent.move.result(), 1);
}

TEST_F(Commands, are_done_after_their_action_without_a_completion) {
    ASSERT_TRUE(urgent.mark.send(7));
    pass(1ms);
    EXPECT_EQ(urgent.mark.state(), CommandState::done);
    EXPECT_THAT(axis.marks, testing::ElementsAre(7));
    constexpr auto reactions = static_cast<std::size_t>(FunctionKind::reactions);
    EXPECT_EQ(instance.engines()[motion].plan().functions[reactions].passes, 1u) << "nothing else is timed";
}

TEST_F(Commands, are_not_sent_when_unconnected) {
    EXPECT_FALSE(urgent.second_mark.connected());
    EXPECT_FALSE(urgent.second_mark.send(1));
    EXPECT_EQ(urgent.second_mark.state(), CommandState::ready);
}

TEST_F(Commands, return_a_wait_at_once_in_virtual_time) {
    ASSERT_TRUE(urgent.mark.send(7));
    EXPECT_FALSE(urgent.mark.wait(10s));
    pass(1ms);
    EXPECT_TRUE(urgent.mark.wait(10s));
}

// ---- the order of serving

TEST_F(Commands, serve_the_urgent_activity_first_and_keep_sender_order) {
    ASSERT_TRUE(panel.second_mark.send(1)); // the other object first: by time of sending, not by table order
    ASSERT_TRUE(panel.mark.send(2));
    ASSERT_TRUE(urgent.mark.send(3));
    pass(1ms);
    EXPECT_THAT(axis.marks, testing::ElementsAre(3, 1, 2));
}

TEST_F(Commands, run_after_the_components_and_before_asynchronous_events) {
    urgent.knock();
    ASSERT_TRUE(urgent.move.send(1.0));
    pass(1ms);
    EXPECT_THAT(axis.order, testing::ElementsAre("step", "command", "event"));
}

// ---- receivers that are not running

TEST_F(Commands, are_rejected_by_a_stopped_receiver_and_fail_when_it_stops) {
    ASSERT_TRUE(urgent.move.send(50.0));
    pass(5ms);
    ASSERT_TRUE(urgent.mark.send(1)); // still in the mailbox
    instance.engines()[motion].stop(clock.now());
    EXPECT_EQ(urgent.move.state(), CommandState::failed);
    EXPECT_EQ(urgent.mark.state(), CommandState::rejected);
    ASSERT_TRUE(urgent.mark.send(2));
    EXPECT_EQ(urgent.mark.state(), CommandState::rejected); // although no engine serves its mailbox
    EXPECT_TRUE(axis.marks.empty());
}

// ---- commands as objects

TEST_F(Commands, wrap_another_and_end_with_it) {
    ASSERT_TRUE(panel.move.send(0.4)); // metres
    pass(3ms);
    EXPECT_EQ(panel.move.state(), CommandState::executing);
    pass(5ms);
    EXPECT_EQ(axis.position, 4.0);
    EXPECT_EQ(panel.move.state(), CommandState::done); // only the end of the inner command wakes its engine
    EXPECT_EQ(panel.move.result(), 4);
}

TEST_F(Commands, forward_another_unchanged_without_code) {
    Panel& near = the<Panel>("near");
    ASSERT_TRUE(near.move.send(3.0));
    pass(3ms);
    EXPECT_EQ(near.move.state(), CommandState::executing);
    pass(10ms);
    EXPECT_EQ(near.move.state(), CommandState::done);
    EXPECT_EQ(near.move.result(), 3);
    ASSERT_TRUE(near.move.send(-3.0));
    pass(3ms);
    EXPECT_EQ(near.move.state(), CommandState::failed);
}

TEST_F(Commands, fail_when_they_wrap_a_rejected_one) {
    ASSERT_TRUE(panel.move.send(-1.0));
    pass(3ms);
    EXPECT_EQ(panel.move.state(), CommandState::failed);
}

TEST_F(Commands, can_be_handed_on_and_monitored_by_their_owner) {
    auto& planner = the<Planner>("planner");
    planner.plan(2.0);
    EXPECT_EQ(planner.move.state(), CommandState::ready);
    pass(5ms);
    EXPECT_EQ(the<Runner>("runner").sent, 1u);
    EXPECT_EQ(planner.move.state(), CommandState::done);
    EXPECT_EQ(planner.move.result(), 2);
}

TEST_F(CommandsDeathTest, break_a_contract_when_another_activity_sends_them) {
    auto& planner = the<Planner>("planner");
    const RunsActivity in_its_own{2}; // the row says sent_by("runner")
    EXPECT_DEATH(static_cast<void>(planner.move.send(1.0)),
                 "command-sender: A command of sending activity 3 was sent in activity 2");
}

// ---- operations for the browser

struct AnySlot {
    CommandSlot slot{};
    std::array<std::byte, 64> values{};
};

TEST_F(Commands, accept_packed_bytes_from_an_untyped_sender) {
    const MachineView& seen = instance.machine().table;
    const End move_to{0, find_facet(seen.components[0], "move_to")};
    const CommandOperations& operations = *facet_at(seen, move_to).command;
    ASSERT_EQ(operations.arguments, type_id<Arguments<double>>);
    ASSERT_EQ(operations.results, type_id<Arguments<int>>);
    AnySlot any;
    ASSERT_TRUE(instance.requests().bind_command(move_to, any.slot, any.values));
    detail::store_packed(any.values.data(), 2.0);
    ASSERT_TRUE(any.slot.send());
    EXPECT_FALSE(instance.requests().bind_command(move_to, any.slot, any.values)); // it is pending
    pass(3ms);
    ASSERT_EQ(any.slot.state(), CommandState::done);
    EXPECT_EQ(detail::load_packed<int>(any.values.data() + operations.argument_bytes), 2);
}

TEST_F(Commands, are_bound_only_to_command_facets_with_enough_room) {
    const MachineView& seen = instance.machine().table;
    AnySlot any;
    EXPECT_FALSE(instance.requests().bind_command({0, find_facet(seen.components[0], "distance")}, any.slot,
                                                  any.values));
    EXPECT_FALSE(instance.requests().bind_command({0, find_facet(seen.components[0], "move_to")}, any.slot,
                                                  std::span{any.values}.first(11)));
}

TEST_F(Commands, keep_table_slots_free_from_a_flood_of_requests) {
    const MachineView& seen = instance.machine().table;
    const End mark{0, find_facet(seen.components[0], "mark")};
    std::vector<AnySlot> many(64);
    std::size_t rejected = 0;
    for (AnySlot& any : many) {
        ASSERT_TRUE(instance.requests().bind_command(mark, any.slot, any.values));
        ASSERT_TRUE(any.slot.send());
        rejected += any.slot.state() == CommandState::rejected ? 1u : 0u;
    }
    EXPECT_EQ(rejected, many.size() - requests_waiting);
    ASSERT_TRUE(panel.mark.send(1));
    ASSERT_TRUE(panel.second_mark.send(2));
    pass(1ms);
    EXPECT_EQ(panel.mark.state(), CommandState::done);
    EXPECT_EQ(panel.second_mark.state(), CommandState::done);
    EXPECT_EQ(axis.marks.size(), 2u + requests_waiting);
}

} // namespace
} // namespace tappet
