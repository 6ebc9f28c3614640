// Parts of a running machine start and stop (thesis 3.1.3: the states and transitions of a deployed
// component; 4.2.2: those of an activity): a component starts only with valid inputs and leaves safe values,
// while the rest of the machine continues.
#include "kernel/machine/instance/instance.hpp"

#include "kernel/base/random.hpp"
#include "kernel/statechart/rows.hpp"
#include "tests/kernel/machine/virtual_rig.hpp"

#include <gmock/gmock.h>

#include <string>
#include <vector>

namespace tappet {
namespace {

/// The supervisor's calls, in order.
std::vector<std::string>& notes() {
    static std::vector<std::string> list;
    return list;
}

/// Measures the angle unless the test silences it; 0 is its safe value.
struct Sensor {
    Output<double> angle;
    bool silent = false;
    std::uint64_t steps = 0;
    std::string_view refuses{};
    Sentence initialise() {
        notes().push_back("sensor initialised");
        return refuses.empty() ? Sentence{} : Sentence{refuses};
    }
    void finalise() { notes().push_back("sensor finalised"); }
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        ++steps;
        if (!silent) angle.write(static_cast<double>(steps));
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        if (!silent) angle.write(0);
    }
    static constexpr auto interface() { return facets(output<&Sensor::angle>("angle", "deg", "0: safe")); }
};

/// Follows the angle; its drive is safe at 0.
struct Axis {
    Input<double> angle;
    Output<double> drive;
    Timer alarm;
    Event<> turned;
    std::uint64_t starts = 0, steps = 0, stops = 0, kicks = 0, alarms = 0;
    std::uint64_t steps_outside = 0; ///< steps before a start or after a stop
    bool runs = false;
    Duration alarm_after{};

    void start(const Cycle& cycle) noexcept TAPPET_REALTIME {
        ++starts;
        runs = true;
        if (alarm_after > Duration::zero()) alarm.arm(cycle.now + alarm_after);
    }
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        ++steps;
        if (!runs) ++steps_outside;
        drive.write(angle.get());
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        ++stops;
        runs = false;
        drive.write(0);
    }
    void kick() noexcept TAPPET_REALTIME {
        ++kicks;
        if (!runs) ++steps_outside;
    }
    void ring(const Cycle&) noexcept TAPPET_REALTIME { ++alarms; }
    static constexpr auto interface() {
        return facets(input<&Axis::angle>("angle", "deg", "to follow"),
                      output<&Axis::drive>("drive", "V", "0: safe"), operation<&Axis::kick>("kick", "counts"),
                      event<&Axis::turned>("turned", "once round"),
                      timer<&Axis::alarm, &Axis::ring>("alarm", "counts"));
    }
};

/// Needs a first angle to work, so it waits for it.
struct Careful {
    Input<double> angle;
    double first_angle = -1;
    void start(const Cycle&) noexcept TAPPET_REALTIME { first_angle = angle.get(); }
    static constexpr auto interface() {
        return facets(input<&Careful::angle>("angle", "deg", "to follow", valid_to_start));
    }
};

/// Emits a press when the test wants it, and may request changes in the machine from its own activity.
struct Panel : Onlooker {
    Event<> pressed;
    std::uint64_t presses_left = 0;
    std::size_t restart_activity = nowhere;
    LifeTicket ticket{};
    void work(const Cycle&) {
        for (; presses_left != 0; --presses_left) pressed();
        if (restart_activity == nowhere) return;
        ticket = machine->life().ask_activity(restart_activity, LifeChange::restart);
        restart_activity = nowhere;
    }
    static constexpr auto interface() {
        return facets(event<&Panel::pressed>("pressed", "somebody presses"));
    }
};

/// Has a state machine that shows its state.
struct Gate {
    int opened = 0, closed = 0;
    void enter_open() noexcept TAPPET_REALTIME { ++opened; }
    void enter_closed() noexcept TAPPET_REALTIME { ++closed; }
    int turns = 0;
    void on_turn() noexcept TAPPET_REALTIME { ++turns; }
    static constexpr auto interface() { return facets(operation<&Gate::on_turn>("on_turn", "counts")); }
};

// clang-format off
constexpr auto gate_cycle = state_machine<Gate>("gate_cycle",
    states(state("open", initial, entry<&Gate::enter_open>), state("closed", final, entry<&Gate::enter_closed>)),
    transitions(transition("open", "closed", after(24h))));

constexpr auto table = machine("lively",
    components(component<Sensor>("sensor"), component<Axis>("axis"), component<Gate>("gate"),
               component<Careful>("careful"), component<Panel>("panel")),
    activities(
        activity("field",  every(1ms),   runs("sensor"),        budget(50us)),
        activity("motion", on_work(),    runs("axis", "gate"),  at_most(8, 1ms), deadline(1ms), budget(20us)),
        activity("slow",   every(10ms),  runs("careful"),       budget(20us)),
        activity("office", every(5ms),   runs("panel"),         not_real_time)),
    connections(
        data("sensor.angle", "axis.angle", stale_after(20ms), hold, wakes),
        data("sensor.angle", "careful.angle")),
    reactions(when("panel.pressed", tell("axis.kick")), when("axis.turned", call("gate.on_turn"))),
    behaviours(behaviour("gate", gate_cycle)));
// clang-format on

constexpr std::size_t sensor = 0, axis = 1, gate = 2, careful = 3, panel = 4;
constexpr std::size_t field = 0, motion = 1, slow = 2, office = 3;

struct Machine : testing::Test, ConfiguredRig<table> {
    Machine() { notes().clear(); }
    /// Starts the machine, then runs it for this time.
    void start(Duration then = {}) {
        ASSERT_EQ(world.start().view(), "");
        pass(then);
    }
    ComponentState state(std::size_t component) { return instance.life().state_of(component); }
    LifeAnswer change(std::size_t component, LifeChange change) {
        return ConfiguredRig::change(component, change, 20ms);
    }
    std::string words(std::size_t component, LifeAnswer answer) {
        return std::string{
            instance.life().describe(instance.machine().index.activity[component], answer).view()};
    }
};

using LifeOfAComponent = Machine;
using LifeOfAnActivity = Machine;

TEST_F(LifeOfAComponent, is_inactive_before_its_activity_starts_and_stopped_after_it_stops) {
    EXPECT_EQ(state(axis), ComponentState::inactive);
    start();
    EXPECT_EQ(state(axis), ComponentState::running);
    pass(5ms);
    world.stop();
    EXPECT_EQ(state(axis), ComponentState::stopped);
    EXPECT_EQ(the<Axis>("axis").stops, 1u);
}

TEST_F(LifeOfAComponent, stops_alone_with_safe_values_while_others_continue) {
    start(10ms);
    EXPECT_GT(the<Axis>("axis").drive.last(), 0.0);
    EXPECT_EQ(change(axis, LifeChange::stop).outcome, LifeOutcome::done);
    EXPECT_EQ(state(axis), ComponentState::stopped);
    EXPECT_EQ(the<Axis>("axis").drive.last(), 0.0);
    const std::uint64_t axis_steps = the<Axis>("axis").steps, sensor_steps = the<Sensor>("sensor").steps;
    pass(30ms);
    EXPECT_EQ(the<Axis>("axis").steps, axis_steps);
    EXPECT_EQ(the<Sensor>("sensor").steps, sensor_steps + 30);
    EXPECT_EQ(state(gate), ComponentState::running); // of the same activity
    EXPECT_EQ(state(sensor), ComponentState::running);
}

TEST_F(LifeOfAComponent, ends_with_one_stop_although_the_machine_stops_later) {
    start(5ms);
    static_cast<void>(change(axis, LifeChange::stop));
    static_cast<void>(change(axis, LifeChange::stop));
    world.stop();
    EXPECT_EQ(the<Axis>("axis").stops, 1u);
}

TEST_F(LifeOfAComponent, restarts_after_its_own_stop) {
    start(5ms);
    static_cast<void>(change(axis, LifeChange::stop));
    EXPECT_EQ(change(axis, LifeChange::start).outcome, LifeOutcome::done);
    EXPECT_EQ(the<Axis>("axis").starts, 2u);
    EXPECT_EQ(change(axis, LifeChange::start).outcome, LifeOutcome::done); // it is already running
    EXPECT_EQ(the<Axis>("axis").starts, 2u);
    EXPECT_EQ(change(axis, LifeChange::restart).outcome, LifeOutcome::done);
    EXPECT_EQ(the<Axis>("axis").starts, 3u);
    EXPECT_EQ(the<Axis>("axis").stops, 2u);
    EXPECT_GT(the<Axis>("axis").drive.last(), 0.0);
}

TEST_F(LifeOfAComponent, does_not_start_before_its_required_input_and_names_it) {
    the<Sensor>("sensor").silent = true;
    start();
    EXPECT_EQ(change(axis, LifeChange::stop).outcome, LifeOutcome::done);
    const LifeAnswer answer = change(axis, LifeChange::start);
    EXPECT_EQ(answer.outcome, LifeOutcome::refused);
    EXPECT_EQ(answer.refusal, LifeRefusal::input_never_written);
    EXPECT_EQ(words(axis, answer),
              "component \"axis\" is not started: its input \"angle\" was never written; "
              "check that \"sensor\" runs and writes \"sensor.angle\"");
    EXPECT_EQ(state(axis), ComponentState::stopped);
    the<Sensor>("sensor").silent = false;
    pass(2ms);
    EXPECT_EQ(change(axis, LifeChange::start).outcome, LifeOutcome::done);
}

TEST_F(LifeOfAComponent, stays_stopped_and_safe_after_a_restart_with_a_stale_input) {
    start(10ms);
    the<Sensor>("sensor").silent = true;
    pass(30ms);
    const LifeAnswer answer = change(axis, LifeChange::restart);
    EXPECT_EQ(answer.outcome, LifeOutcome::refused);
    EXPECT_EQ(answer.refusal, LifeRefusal::input_stale);
    EXPECT_THAT(words(axis, answer),
                testing::HasSubstr("its input \"angle\" is stale; check that \"sensor\" runs"));
    EXPECT_EQ(state(axis), ComponentState::stopped);
    EXPECT_EQ(the<Axis>("axis").drive.last(), 0.0);
}

TEST_F(LifeOfAComponent, waits_for_an_input_that_is_required_from_the_start) {
    the<Sensor>("sensor").silent = true;
    start(50ms);
    EXPECT_EQ(state(careful), ComponentState::waiting);
    EXPECT_EQ(the<Careful>("careful").first_angle, -1.0);
    EXPECT_EQ(state(axis), ComponentState::running); // it did not require the input
    the<Sensor>("sensor").silent = false;
    pass(20ms);
    EXPECT_EQ(state(careful), ComponentState::running);
    EXPECT_GT(the<Careful>("careful").first_angle, 50.0);
}

TEST_F(LifeOfAComponent, drops_and_counts_messages_while_it_is_not_running) {
    start(5ms);
    static_cast<void>(change(axis, LifeChange::stop));
    the<Panel>("panel").presses_left = 3;
    pass(20ms);
    EXPECT_EQ(the<Axis>("axis").kicks, 0u);
    EXPECT_EQ(instance.observation().dropped_messages(), 3u);
    static_cast<void>(change(axis, LifeChange::start));
    EXPECT_EQ(the<Axis>("axis").kicks, 0u) << "what was dropped does not come later";
    the<Panel>("panel").presses_left = 2;
    pass(20ms);
    EXPECT_EQ(the<Axis>("axis").kicks, 2u);
    EXPECT_EQ(instance.observation().lost_emissions(), 0u);
}

TEST_F(LifeOfAComponent, refuses_and_counts_synchronous_calls_while_it_is_stopped) {
    start(5ms);
    Axis& the_axis = the<Axis>("axis");
    the_axis.turned();
    EXPECT_EQ(the<Gate>("gate").turns, 1);
    static_cast<void>(change(gate, LifeChange::stop));
    the_axis.turned();
    the_axis.turned();
    EXPECT_EQ(the<Gate>("gate").turns, 1);
    EXPECT_EQ(instance.observation().dropped_messages(), 2u);
    static_cast<void>(change(gate, LifeChange::start));
    the_axis.turned();
    EXPECT_EQ(the<Gate>("gate").turns, 2);
}

TEST_F(LifeOfAComponent, forgets_its_timers_when_it_stops) {
    the<Axis>("axis").alarm_after = 50ms;
    start(10ms);
    static_cast<void>(change(axis, LifeChange::stop));
    pass(100ms);
    EXPECT_EQ(the<Axis>("axis").alarms, 0u);
    static_cast<void>(change(axis, LifeChange::start));
    pass(100ms);
    EXPECT_EQ(the<Axis>("axis").alarms, 1u);
}

TEST_F(LifeOfAComponent, leads_its_state_machine_to_the_final_state_and_back) {
    start(5ms);
    EXPECT_EQ(the<Gate>("gate").opened, 1);
    static_cast<void>(change(gate, LifeChange::stop));
    EXPECT_EQ(the<Gate>("gate").closed, 1);
    static_cast<void>(change(gate, LifeChange::start));
    EXPECT_EQ(the<Gate>("gate").opened, 2);
    EXPECT_EQ(the<Axis>("axis").starts, 1u); // its neighbour was not affected
}

TEST_F(LifeOfAComponent, follows_the_last_of_several_requests_and_marks_others_superseded) {
    start(5ms);
    const LifeTicket first = instance.life().ask_component(axis, LifeChange::restart);
    const LifeTicket second = instance.life().ask_component(axis, LifeChange::stop);
    pass(5ms);
    EXPECT_EQ(instance.life().answer_of_component(axis, first).outcome, LifeOutcome::superseded);
    EXPECT_EQ(instance.life().answer_of_component(axis, second).outcome, LifeOutcome::done);
    EXPECT_EQ(state(axis), ComponentState::stopped);
    EXPECT_EQ(the<Axis>("axis").starts, 1u);
}

/// Runs one machine under a hundred random requests; returns the digest of its event log.
std::uint64_t under_random_requests(std::uint64_t seed) {
    Random random{seed};
    RunningRig<table> rig;
    MachineInstance& instance = rig.instance;
    const Axis& the_axis = rig.the<Axis>("axis");
    for (int n = 0; n < 100 && !testing::Test::HasFailure(); ++n) {
        const auto component = static_cast<std::size_t>(random.between(sensor, careful));
        const auto change = static_cast<LifeChange>(random.between(0, 2));
        rig.the<Panel>("panel").presses_left += static_cast<std::uint64_t>(random.between(0, 2));
        const LifeTicket ticket = instance.life().ask_component(component, change);
        EXPECT_TRUE(rig.run(10ms));
        const LifeAnswer answer = instance.life().answer_of_component(component, ticket);
        EXPECT_NE(answer.outcome, LifeOutcome::pending);
        const bool runs = answer.outcome == LifeOutcome::done && change != LifeChange::stop;
        if (answer.outcome == LifeOutcome::done || change == LifeChange::restart) {
            EXPECT_EQ(instance.life().state_of(component),
                      runs ? ComponentState::running : ComponentState::stopped)
                << "seed " << seed << ", request " << n;
        }
        if (instance.life().state_of(axis) != ComponentState::running) {
            EXPECT_EQ(the_axis.drive.last(), 0.0);
        }
    }
    EXPECT_EQ(the_axis.steps_outside, 0u) << "seed " << seed;
    rig.world.stop();
    return instance.observation().event_log_digest();
}

TEST(LifeUnderRandomRequests, steps_and_calls_running_components_only_and_repeats_exactly) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const std::uint64_t first = under_random_requests(seed);
        EXPECT_EQ(under_random_requests(seed), first) << "seed " << seed;
        EXPECT_NE(under_random_requests(seed + 1000), first);
    }
}

TEST_F(LifeOfAnActivity, initialises_before_a_start_and_finalises_after_a_stop) {
    start();
    EXPECT_THAT(notes(), testing::ElementsAre("sensor initialised"));
    pass(10ms);
    EXPECT_EQ(world.change_activity(field, LifeChange::stop).view(), "");
    EXPECT_THAT(notes(), testing::ElementsAre("sensor initialised", "sensor finalised"));
    EXPECT_EQ(state(sensor), ComponentState::stopped);
    EXPECT_EQ(the<Sensor>("sensor").angle.last(), 0.0);
    const std::uint64_t steps = the<Sensor>("sensor").steps;
    pass(50ms);
    EXPECT_EQ(the<Sensor>("sensor").steps, steps);
    EXPECT_EQ(world.change_activity(field, LifeChange::restart).view(), "");
    pass(10ms);
    EXPECT_EQ(the<Sensor>("sensor").steps, steps + 10) << "no period is made up for";
    world.stop();
    EXPECT_THAT(notes(), testing::ElementsAre("sensor initialised", "sensor finalised", "sensor initialised",
                                              "sensor finalised"));
}

TEST_F(LifeOfAnActivity, stays_stopped_until_its_components_can_be_initialised) {
    start(10ms);
    the<Sensor>("sensor").refuses = "the probe is not plugged in; plug it in";
    EXPECT_EQ(world.change_activity(field, LifeChange::restart).view(),
              "component \"sensor\" could not be initialised: the probe is not plugged in; plug it in");
    EXPECT_EQ(state(sensor), ComponentState::failed);
    EXPECT_EQ(instance.life()
                  .answer_of_component(sensor, instance.life().ask_component(sensor, LifeChange::start))
                  .outcome,
              LifeOutcome::refused);
    pass(10ms); // the others continue
    the<Sensor>("sensor").refuses = {};
    EXPECT_EQ(world.change_activity(field, LifeChange::start).view(), "");
    EXPECT_EQ(state(sensor), ComponentState::running);
}

TEST_F(LifeOfAnActivity, fails_the_machine_start_and_stops_what_had_started) {
    the<Sensor>("sensor").refuses = "no probe";
    EXPECT_EQ(world.start().view(), "component \"sensor\" could not be initialised: no probe");
    for (const std::size_t component : {axis, gate, careful, panel})
        EXPECT_NE(state(component), ComponentState::running);
    EXPECT_EQ(state(sensor), ComponentState::failed);
}

TEST_F(LifeOfAnActivity, does_not_start_while_a_required_value_is_stale) {
    start(10ms);
    EXPECT_EQ(world.change_activity(motion, LifeChange::stop).view(), "");
    EXPECT_EQ(world.change_activity(field, LifeChange::stop).view(), "");
    pass(30ms);
    EXPECT_THAT(std::string{world.change_activity(motion, LifeChange::start).view()},
                testing::HasSubstr("component \"axis\" is not started: its input \"angle\" is stale"));
    EXPECT_EQ(state(axis), ComponentState::stopped);
    EXPECT_EQ(world.change_activity(field, LifeChange::start).view(), "");
    pass(5ms);
    EXPECT_EQ(world.change_activity(motion, LifeChange::start).view(), "");
    pass(5ms);
    EXPECT_GT(the<Axis>("axis").drive.last(), 0.0);
}

TEST_F(LifeOfAnActivity, drops_messages_to_its_components_while_it_is_stopped) {
    start(10ms);
    EXPECT_EQ(world.change_activity(motion, LifeChange::stop).view(), "");
    the<Panel>("panel").presses_left = 5;
    pass(10ms);
    EXPECT_EQ(world.change_activity(motion, LifeChange::start).view(), "");
    pass(10ms);
    EXPECT_EQ(the<Axis>("axis").kicks, 0u);
    EXPECT_EQ(instance.observation().dropped_messages(), 5u);
    EXPECT_EQ(instance.observation().lost_emissions(), 0u);
}

TEST_F(LifeOfAnActivity, refuses_requests_to_its_components_while_it_is_stopped) {
    start(10ms);
    EXPECT_EQ(world.change_activity(motion, LifeChange::stop).view(), "");
    const LifeAnswer answer = change(axis, LifeChange::start);
    EXPECT_EQ(answer.refusal, LifeRefusal::activity_stopped);
    EXPECT_EQ(words(axis, answer),
              "component \"axis\" is not started: its activity \"motion\" does not run; start that");
}

TEST_F(LifeOfAnActivity, is_restarted_by_the_supervisor_at_a_components_request) {
    start(10ms);
    the<Panel>("panel").restart_activity = motion;
    pass(10ms);
    EXPECT_EQ(instance.life().answer_of_activity(motion, the<Panel>("panel").ticket).outcome,
              LifeOutcome::done);
    EXPECT_EQ(the<Axis>("axis").starts, 2u);
    the<Panel>("panel").restart_activity = office; // and its own activity
    pass(10ms);
    EXPECT_EQ(instance.life().answer_of_activity(office, the<Panel>("panel").ticket).outcome,
              LifeOutcome::done);
    EXPECT_EQ(state(panel), ComponentState::running);
    EXPECT_EQ(instance.engines()[slow].is_active(), true);
}

} // namespace
} // namespace tappet
