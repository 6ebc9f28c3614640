// Nothing reaches a stopped component, and its outputs keep their safe values: by any way, started before the
// stop or after it.
#include "kernel/services/interpreter/command_interpreter.hpp"
#include "tests/kernel/services/browsing/press_rig.hpp"

#include <gmock/gmock.h>

namespace tappet {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// Every entry switches the coil on.
struct Valve {
    Output<bool> coil;
    BufferOutput<std::int64_t> strokes;
    Property<double> pressure{1.0};
    Event<> closed;
    std::int64_t changes = 0;

    void start(const Cycle&) noexcept TAPPET_REALTIME { coil.write(false); }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        coil.write(false);
        closed.emit();
    }
    void changed() noexcept TAPPET_REALTIME {
        ++changes;
        coil.write(true);
        static_cast<void>(strokes.push(changes));
    }
    void on() noexcept TAPPET_REALTIME { coil.write(true); }
    bool open() noexcept TAPPET_REALTIME {
        coil.write(true);
        return true;
    }
    std::int64_t count() noexcept TAPPET_REALTIME {
        coil.write(true);
        return 7;
    }
    bool go() noexcept TAPPET_REALTIME {
        coil.write(true);
        return true;
    }
    static constexpr auto interface() {
        return facets(output<&Valve::coil>("coil", "", "true: it flows"),
                      output<&Valve::strokes>("strokes", "", "that were made"),
                      event<&Valve::closed>("closed", "it has stopped"),
                      property<&Valve::pressure>("pressure", "bar", "wanted", range(0, 10)),
                      operation<&Valve::on>("on", "opens it"), method<&Valve::open>("open", "opens it"),
                      method<&Valve::count>("count", "opens it and counts"),
                      command<&Valve::go>("go", "opens it"));
    }
};

/// It starts when there is air.
struct Spare {
    Input<bool> air;
    bool open() noexcept TAPPET_REALTIME { return true; }
    static constexpr auto interface() {
        return facets(input<&Spare::air>("air", "", "there is some", valid_to_start),
                      method<&Spare::open>("open", "opens it"));
    }
};

/// Calls the valve in each step when the test wants it.
struct Panel {
    Output<bool> air;
    MethodCall<bool()> open, open_spare;
    CommandCall<> go;
    Event<> called, told;
    bool asks = false, asks_back = false, has_air = false;
    std::int64_t answers = 0, refusals = 0, answers_of_spare = 0;

    void start(const Cycle&) noexcept TAPPET_REALTIME {
        if (open_spare().given()) ++answers_of_spare; // which comes later in order, and may still be waiting
    }
    void on_closed() noexcept TAPPET_REALTIME {
        if (asks_back) open().given() ? ++answers : ++refusals;
    }
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        if (has_air) air.write(true);
        if (!asks) return;
        if (open_spare().given()) ++answers_of_spare;
        open().given() ? ++answers : ++refusals;
        called.emit();
        told.emit();
        static_cast<void>(go.send());
    }
    static constexpr auto interface() {
        return facets(output<&Panel::air>("air", "", "there is some"),
                      calls<&Panel::open>("open", "the valve"),
                      calls<&Panel::open_spare>("open_spare", "the one that waits for air"),
                      sends<&Panel::go>("go", "the valve"), event<&Panel::called>("called", "at once"),
                      event<&Panel::told>("told", "by a message"),
                      operation<&Panel::on_closed>("on_closed", "the valve has stopped"));
    }
};

/// The other end of the wire: records whether it was ever on.
struct Wire {
    Input<bool> level;
    bool was_on = false;
    void step(const Cycle&) noexcept TAPPET_REALTIME { was_on |= level.get(); }
    static constexpr auto interface() { return facets(input<&Wire::level>("level", "", "of the coil")); }
};

/// A script drives it.
struct Feeder {
    Event<> tick;
    std::int64_t failures = 0;
    void count_failure() noexcept TAPPET_REALTIME { ++failures; }
    static constexpr auto interface() {
        return facets(event<&Feeder::tick>("tick", "of the test"),
                      method<&Feeder::count_failure>("count_failure", "the script saw a call fail"));
    }
};

// clang-format off
constexpr auto table = machine("plant",
    components(component<Valve>("valve"), component<Spare>("spare"), component<Panel>("panel"), component<Feeder>("feeder"), component<Wire>("wire"),
               component<BrowserService>("browser", set("log", false)), component<CommandInterpreter>("interpreter")),
    activities(
        activity("motion",  every(1ms), budget(50us), runs("valve", "panel", "spare", "feeder")),
        activity("io",      every(1ms), budget(50us), runs("wire")),
        activity("browser", every(20ms), not_real_time, stack(256 * 1024), runs("browser", "interpreter"))),
    connections(data("valve.coil", "wire.level"), data("panel.air", "spare.air")),
    reactions(uses("panel.open", "valve.open"), uses("panel.open_spare", "spare.open"), uses("panel.go", "valve.go"),
              when("panel.called", call("valve.on")), when("panel.told", tell("valve.on")),
              when("valve.closed", call("panel.on_closed"))),
    behaviours(behaviour("feeder", slot(nodes(60), data_bytes(512), depth(3), command_slots(2), timers(2), text_bytes(2000),
                                        peers("valve"), operations("valve.on", "valve.open", "valve.count"), trial(2)), at_most(30))));
// clang-format on

class AStoppedComponent : public press::Browsed<table> {
protected:
    /// All packets within the time, after requests that were sent at once.
    std::string ask(std::initializer_list<std::string_view> requests, Duration time = 60ms) {
        for (const std::string_view each : requests) EXPECT_TRUE(talker().send(each));
        run(time);
        return talker().receive_all();
    }
    Valve& valve() { return the<Valve>("valve"); }
    Panel& panel() { return the<Panel>("panel"); }
    Wire& wire() { return the<Wire>("wire"); }
    Feeder& feeder() { return the<Feeder>("feeder"); }
    std::uint32_t dropped_writes() {
        return instance.gate_of(find_component(instance.machine().table, "valve"))->dropped_writes;
    }
    /// From here on nothing may switch the coil on.
    void stop_valve() {
        EXPECT_THAT(ask({"90 stop valve"}), HasSubstr(R"("id": 90, "ok": true)"));
        expect_safe_from_now();
    }
    void expect_safe_from_now() {
        EXPECT_FALSE(valve().coil.last());
        wire().was_on = false;
    }
    void TearDown() override {
        run(200ms);
        EXPECT_FALSE(wire().was_on) << "the coil of a valve that does not run was on";
        EXPECT_FALSE(valve().coil.last());
    }
};

TEST_F(AStoppedComponent, refuses_a_call_in_the_cycle_of_its_stop) {
    const std::string answers = ask(
        {"1 stop valve", "2 call valve.open", "3 call valve.on", "4 call valve.count", "5 send valve.go"});
    EXPECT_THAT(answers, AllOf(HasSubstr(R"("id": 1, "ok": true)"), HasSubstr(R"("id": 2, "ok": false)"),
                               HasSubstr(R"("id": 3, "ok": false)"), HasSubstr(R"("id": 4, "ok": false)")))
        << answers;
    EXPECT_THAT(answers, HasSubstr(R"(component \"valve\" does not run; start it first)"));
    EXPECT_THAT(answers, Not(HasSubstr(R"("result")"))) << "nothing ran that could answer";
    EXPECT_THAT(answers, HasSubstr("rejected"));
}

TEST_F(AStoppedComponent, refuses_method_calls_and_runs_no_reaction) {
    stop_valve();
    panel().asks = true;
    run(20ms);
    EXPECT_EQ(panel().answers, 0);
    EXPECT_GT(panel().refusals, 10);
    EXPECT_GT(instance.observation().dropped_messages(), 20u) << "both kinds of reactions are counted";
    panel().asks = false;
    EXPECT_THAT(ask({"1 start valve"}), HasSubstr(R"("ok": true)"));
    panel().asks = true;
    run(5ms);
    EXPECT_GT(panel().answers, 3) << "it runs again";
    panel().asks = false;
    stop_valve();
}

TEST_F(AStoppedComponent, is_not_called_back_by_peers_that_its_stop_notifies) {
    panel().asks_back = true;
    stop_valve();
    EXPECT_EQ(panel().answers, 0);
    EXPECT_EQ(panel().refusals, 1);
    EXPECT_THAT(ask({"1 start valve"}), HasSubstr(R"("ok": true)"));
    world.stop();
    EXPECT_EQ(panel().answers, 0) << "nor when the whole machine stops";
    EXPECT_FALSE(valve().coil.last());
    wire().was_on = false;
}

TEST_F(AStoppedComponent, can_receive_its_awaited_input_by_hand) {
    EXPECT_THAT(ask({"1 force spare.air true"}), HasSubstr(R"("ok": true)"));
    panel().asks = true;
    run(20ms);
    EXPECT_GT(panel().answers_of_spare, 0) << "it has begun";
    panel().asks = false;
    stop_valve();
}

TEST_F(AStoppedComponent, refuses_calls_before_its_first_start) {
    panel().asks = true;
    run(20ms);
    EXPECT_EQ(panel().answers_of_spare, 0) << "it waits for air";
    EXPECT_THAT(ask({"1 call spare.open"}), HasSubstr("does not run"));
    panel().has_air = true;
    run(20ms);
    EXPECT_GT(panel().answers_of_spare, 0);
    panel().asks = false;
    stop_valve();
}

TEST_F(AStoppedComponent, fails_a_line_that_started_before_the_stop) {
    for (const char* line : {"wait(300ms); do valve.open();", "wait(300ms); do valve.on();",
                             "wait(300ms); var int n = valve.count();", "wait(300ms); do valve.go();"}) {
        EXPECT_THAT(ask({std::string{"1 execute \""} + line + "\""}), HasSubstr("sent")) << line;
        stop_valve();
        EXPECT_THAT(ask({}, 500ms), AllOf(HasSubstr(R"("line": "failed")"), HasSubstr("does not run")))
            << line;
        EXPECT_FALSE(wire().was_on) << line;
        EXPECT_THAT(ask({"2 start valve"}), HasSubstr(R"("ok": true)"));
    }
    stop_valve();
}

TEST_F(AStoppedComponent, fails_the_call_of_a_loaded_script) {
    BehaviourSlot& slot = *instance.slot_of("feeder");
    constexpr std::string_view script = R"(StateMachine Feeding {
    initial state Waits { transition feeder.tick() select Opens }
    state Opens {
        entry {
            try do valve.open(); catch do feeder.count_failure();
            try do valve.on(); catch do feeder.count_failure();
            try do valve.count(); catch do feeder.count_failure();
        }
        transition feeder.tick() select Waits
    }
    final state End {}
})";
    ASSERT_EQ(compile(slot, script, "feeding.osd"), "");
    change(slot, BehaviourSlot::Change::take_over);
    run(5ms);
    stop_valve();
    feeder().tick.emit();
    run(5ms);
    EXPECT_EQ(feeder().failures, 3);
}

TEST_F(AStoppedComponent, accepts_properties_but_drops_and_counts_the_resulting_writes) {
    stop_valve();
    const std::uint32_t before = dropped_writes();
    const std::int64_t told = valve().changes;
    EXPECT_THAT(ask({"1 set valve.pressure 3"}), HasSubstr(R"("ok": true)"));
    EXPECT_EQ(valve().pressure.get(), 3.0);
    EXPECT_EQ(valve().changes - told, 1) << "it is told";
    EXPECT_EQ(dropped_writes() - before, 2u) << "of the coil and of the buffered output";
    EXPECT_THAT(ask({"2 execute \"set valve.pressure = 4.0\""}), HasSubstr("sent"));
    EXPECT_EQ(valve().pressure.get(), 4.0);
    EXPECT_EQ(dropped_writes() - before, 4u);
}

TEST_F(AStoppedComponent, refuses_forces_on_its_outputs) {
    EXPECT_THAT(ask({"1 stop valve", "2 force valve.coil true"}),
                HasSubstr(R"(component \"valve\" does not run; start it first)"));
    EXPECT_THAT(ask({"3 force valve.coil true"}), HasSubstr("does not run"));
}

TEST_F(AStoppedComponent, is_unreachable_also_when_its_activity_was_stopped) {
    panel().asks = true;
    EXPECT_THAT(ask({"1 stop motion"}), HasSubstr(R"("ok": true)"));
    expect_safe_from_now();
    ask({"2 call valve.open", "3 call valve.on", "4 send valve.go", "5 set valve.pressure 9",
         "6 execute \"do valve.open();\"", "7 force valve.coil true"});
}

} // namespace
} // namespace tappet
