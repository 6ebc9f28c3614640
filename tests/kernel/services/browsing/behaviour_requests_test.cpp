// A browser sees behaviours, commands them, and loads scripts into a slot of the running machine (thesis 4.8,
// 5.1.6, 5.2.5): a forbidden or misspelt request is refused with its cure.
#include "kernel/machine/plan/operations.hpp"
#include "tests/kernel/services/browsing/press_rig.hpp"

#include <gmock/gmock.h>

namespace tappet::press {
namespace {

using testing::HasSubstr;

struct RamCycle {
    static constexpr auto machine() {
        return state_machine<Ram>(
            "cycle", states(state("up", initial), state("down"), state("held"), state("safe", final)),
            transitions(
                transition("up", "down", on("arrived")), transition("down", "up", on("arrived")),
                transition("down", "held", guard<&Ram::may_hold>.because<&Ram::why_not>("it may not hold")),
                transition("down", "held", after(1h), because("it was long enough")),
                transition("held", "up", on("arrived"))));
    }
};
constexpr auto cycle = RamCycle::machine();

// clang-format off
constexpr auto with_behaviours = machine("press",
    components(component<Ram>("ram"), component<Table>("table"), component<BrowserService>("browser", set("log", false))),
    activities(
        activity("motion",  every(1ms), budget(50us), runs("ram")),
        activity("slow",    every(10ms), budget(50us), runs("table")),
        activity("browser", every(20ms), not_real_time, stack(256 * 1024), runs("browser"))),
    connections(data("table.height", "ram.limit", stale_after(1s), hold)),
    reactions(),
    behaviours(behaviour("ram", cycle),
               behaviour("ram", slot(nodes(60), data_bytes(512), depth(3), command_slots(1), timers(4), trial(1)))));
// clang-format on

constexpr std::string_view script = "StateMachine Pressing {\n"
                                    "    var int strokes = 0;\n"
                                    "    initial state Waiting { transition ram.arrived() select Counting }\n"
                                    "    state Counting { entry { set strokes = strokes + 1; }\n"
                                    "        transition ram.arrived() select Waiting }\n"
                                    "    final state Safe { }\n"
                                    "}\n";

std::string in_quotes(std::string_view text) {
    std::string word{"\""};
    for (const char character : text)
        word += character == '"' || character == '\\' ? std::string{'\\', character} : std::string{character};
    return word + "\"";
}

class Behaviours : public Browsed<with_behaviours> {
protected:
    std::string ask(std::string_view request) { return Browsed::ask("1 " + std::string{request}); }
    Ram& ram() { return the<Ram>("ram"); }
    std::string load(std::string_view text, std::string_view moment = "now") {
        constexpr std::size_t piece = 50;
        for (std::size_t at = 0; at < text.size(); at += piece)
            EXPECT_THAT(ask("script ram " + std::to_string(at) + " " + in_quotes(text.substr(at, piece))),
                        HasSubstr("\"ok\": true"));
        return ask("load ram pressing.osd " + std::string{moment});
    }
};

TEST_F(Behaviours, list_shows_each_with_its_status_and_state) {
    const std::string list = ask("behaviours");
    EXPECT_THAT(list,
                HasSubstr(R"({"name": "ram.cycle", "kind": "machine", "status": "running", "state": "up"})"));
    EXPECT_THAT(list, HasSubstr(R"("slot": "ram", "phase": "empty")"));
    ram().arrived.emit(1.0);
    run(5ms);
    EXPECT_THAT(ask("behaviours ram.cycle"), HasSubstr(R"("state": "down", )"));
    EXPECT_THAT(ask("behaviours ram.cicle"), HasSubstr("did you mean \\\"ram.cycle\\\"?"));
}

TEST_F(Behaviours, can_be_paused_stepped_and_sent_to_a_state) {
    EXPECT_THAT(ask("behave pause ram.cycle"), HasSubstr("\"ok\": true"));
    EXPECT_THAT(ask("behaviours ram.cycle"), HasSubstr("paused"));
    ram().arrived.emit(1.0);
    run(5ms);
    EXPECT_THAT(ask("behaviours ram.cycle"), HasSubstr(R"("state": "up")"));
    EXPECT_THAT(ask("behave step ram.cycle"), HasSubstr("\"ok\": true")) << "the event is one step";
    EXPECT_THAT(ask("behave step ram.cycle"), HasSubstr("\"ok\": true")) << "what it leads to another";
    EXPECT_THAT(ask("behaviours ram.cycle"), HasSubstr(R"("state": "down")"));
    EXPECT_THAT(ask("behave start ram.cycle"), HasSubstr("\"ok\": true"));
    EXPECT_THAT(ask("behave request ram.cycle safe"), HasSubstr("\"ok\": true"));
    EXPECT_THAT(ask("behaviours ram.cycle"), HasSubstr(R"("state": "safe")"));
    EXPECT_THAT(ask("behave request ram.cycle saef"), HasSubstr("did you mean \\\"safe\\\"?"));
    EXPECT_THAT(ask("behave jump ram.cycle"), HasSubstr("bad_request"));
    EXPECT_THAT(ask("behave request ram.cycle"), HasSubstr("bad_request"));
    EXPECT_THAT(ask("behave step ram.cycle"), HasSubstr("not_now")); // it is not paused
}

TEST_F(Behaviours, report_why_they_are_not_in_a_state) {
    EXPECT_THAT(ask("why ram.held"),
                HasSubstr(R"("name": "ram.cycle", "status": "running", "state": "up", "wanted": "held", )"
                          R"("is_final": false, "path": ["up", "down", "held"], )"
                          R"("ways": [{"from": "up", "to": "down", "event": "arrived", "answer": "open"}])"));
    ram().arrived.emit(1.0);
    run(5ms);
    const std::string why = ask("why ram.cycle.held");
    EXPECT_THAT(why, HasSubstr(R"("answer": "guard", "because": "it may not hold", "detail": "too fast"})"));
    EXPECT_THAT(why, HasSubstr(R"("reason": "it was long enough", "answer": "too_early", "left_ns": 35)"));
    EXPECT_THAT(ask("why ram.down"), HasSubstr(R"("path": ["down"], "ways": [])")) << "it is there";
    EXPECT_THAT(ask("why ram.safe"), HasSubstr(R"("is_final": true, "path": [], "ways": [])"));
    EXPECT_THAT(ask("behaviours ram.cycle"), HasSubstr(R"("state": "down")")) << "asking takes nothing";
}

TEST_F(Behaviours, cancel_a_why_request_when_their_script_is_replaced) {
    const std::string large{"StateMachine Pressing {\n"
                            "    initial state Waiting { transition ram.arrived() select A }\n"
                            "    state A { transition ram.arrived() select B }\n"
                            "    state B { transition ram.arrived() select C }\n"
                            "    state C { transition ram.arrived() select Far }\n"
                            "    state Far { transition ram.arrived() select Waiting }\n"
                            "    final state Safe { }\n"
                            "}\n"};
    // Requested for one script in one cycle of the service, and answered when another script occupies its
    // memory.
    for (int round = 0; round < 8; ++round) {
        EXPECT_THAT(load(large), HasSubstr("\"ok\": true"));
        run(50ms);
        ASSERT_TRUE(talker().send("2 why ram.Far"));
        ASSERT_TRUE(talker().send("3 unload ram"));
        for (int again = 0; again < 2; ++again) { // the first one arrives during the unloading
            ASSERT_TRUE(talker().send("4 script ram 0 " + in_quotes(script)));
            ASSERT_TRUE(talker().send("5 load ram pressing.tappet"));
        }
        run(100ms);
        const std::string answers = talker().receive_all();
        EXPECT_THAT(answers, testing::ContainsRegex("\"id\": 5, \"ok\": true")) << "another stands there";
        EXPECT_THAT(answers, testing::ContainsRegex("\"id\": 2, .*another script took over"));
        ASSERT_TRUE(talker().send("6 unload ram"));
        run(100ms);
        static_cast<void>(talker().receive());
    }
}

TEST_F(Behaviours, serve_higher_roles_despite_endless_observer_requests) {
    if (geteuid() != 0) GTEST_SKIP() << "only root can connect as somebody else";
    hang(0);
    std::vector<std::unique_ptr<Talker>> observers;
    for (int i = 0; i < 4; ++i) observers.push_back(std::make_unique<Talker>(path(), 65534));
    for (const auto& each : observers)
        for (std::size_t n = 0; n < BrowserService::max_pending; ++n)
            ASSERT_TRUE(each->send("1 why ram.held"));
    run(100ms);
    EXPECT_THAT(ask("force table.height 7"), HasSubstr("\"ok\": true"));
    std::string answers;
    for (const auto& each : observers) answers += each->receive_all();
    EXPECT_THAT(answers, HasSubstr("too many requests are under way"));
}

TEST_F(Behaviours, keep_mailbox_room_despite_observer_requests_to_a_hung_engine) {
    if (geteuid() != 0) GTEST_SKIP() << "only root can connect as somebody else";
    Engine& engine = hang(0);
    Talker observer{path(), 65534};
    std::string answers;
    for (std::size_t n = 0; n < 2 * requests_waiting; ++n) {
        ASSERT_TRUE(observer.send("1 why ram.held"));
        run(n % 4 == 3 ? BrowserService::patience + 100ms : 30ms); // a withdrawn request still occupies it
        answers += observer.receive_all();
    }
    EXPECT_THAT(answers, HasSubstr("that engine has too many requests to serve"));
    ASSERT_TRUE(talker().send("2 force ram.place 7"));
    run(100ms);
    EXPECT_EQ(talker().receive(), "") << "it waits for its engine";
    engine.start(clock.now());
    run(100ms);
    EXPECT_THAT(talker().receive(), HasSubstr("\"id\": 2, \"ok\": true"));
}

TEST_F(Behaviours, suggest_the_nearest_name_in_a_why_request) {
    EXPECT_THAT(ask("why ram.hold"), HasSubstr(R"(has a state \"hold\"; did you mean \"held\"?)"));
    EXPECT_THAT(ask("why rum.held"), HasSubstr(R"(no state machine of \"rum\"; did you mean \"ram\"?)"));
    EXPECT_THAT(ask("why held"), HasSubstr("spell it COMPONENT.STATE"));
    EXPECT_THAT(ask("why ram.cycle."), HasSubstr("no state machine"));
}

TEST_F(Behaviours, accept_a_script_in_pieces_and_show_its_variables) {
    EXPECT_THAT(load(script), HasSubstr("\"ok\": true"));
    run(5ms);
    ram().arrived.emit(1.0);
    run(30ms);
    const std::string seen = ask("behaviours ram");
    EXPECT_THAT(seen, HasSubstr(R"("name": "ram.Pressing")"));
    EXPECT_THAT(seen, HasSubstr(R"("state": "Counting")"));
    EXPECT_THAT(seen, HasSubstr(R"("strokes": 1)"));
    EXPECT_THAT(seen, HasSubstr(R"("phase": "steady", "script": "pressing.osd")"));
    EXPECT_THAT(ask("unload ram"), HasSubstr("\"ok\": true"));
    run(10ms);
    EXPECT_THAT(ask("behaviours"), HasSubstr(R"("phase": "empty")"));
}

TEST_F(Behaviours, refuse_a_faulty_script_with_file_line_and_column) {
    std::string faulty{script};
    faulty.replace(faulty.find("strokes + 1"), 7, "stroke");
    const std::string answer = load(faulty);
    EXPECT_THAT(answer, HasSubstr("bad_value"));
    EXPECT_THAT(answer, HasSubstr("pressing.osd:4:"));
    EXPECT_THAT(answer, HasSubstr("did you mean \\\"strokes\\\"?"));
    EXPECT_THAT(ask("behaviours"), HasSubstr(R"("phase": "empty")"));
}

TEST_F(Behaviours, refuse_pieces_out_of_order_and_loads_without_a_script) {
    EXPECT_THAT(ask("load ram x.osd"), HasSubstr("no script was sent"));
    EXPECT_THAT(ask("script ram 5 \"x\""), HasSubstr("begin again"));
    EXPECT_THAT(ask("script rum 0 \"x\""), HasSubstr("did you mean \\\"ram\\\"?"));
    EXPECT_THAT(ask("script ram x \"x\""), HasSubstr("bad_request"));
    std::string filling(2000, ' ');
    EXPECT_THAT(ask("script ram 0 " + in_quotes(filling)), HasSubstr("\"bytes\": 2000"));
    EXPECT_THAT(ask("script ram 2000 " + in_quotes(filling)), HasSubstr("room for 2880"));
    EXPECT_THAT(ask("rollback ram"), HasSubstr("did you mean \\\"roll_back\\\"?"));
    EXPECT_THAT(ask("roll_back ram"), HasSubstr("no earlier behaviour"));
}

TEST_F(Behaviours, are_rolled_back_after_a_failed_trial_and_the_slot_says_why) {
    EXPECT_THAT(load("var int n = 0;\nset n = 1 / n;\n"), HasSubstr("\"ok\": true"));
    run(10ms);
    const std::string seen = ask("behaviours");
    EXPECT_THAT(seen, HasSubstr(R"("phase": "empty")"));
    EXPECT_THAT(seen, HasSubstr("failed in line 2"));
}

} // namespace
} // namespace tappet::press
