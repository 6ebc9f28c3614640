// The requests of a browser (thesis 4.8): every facet of a component's interface is accessible from outside,
// the component's own engine executes the request, and a faulty one is refused with the cure.
#include "tests/kernel/services/browsing/press_rig.hpp"

#include "kernel/machine/map/view.hpp"

namespace tappet::press {
namespace {

TEST_F(Press, hello_reports_the_machine_and_the_role_of_the_client) {
    const std::string answer = ask("7 hello");
    for (const char* part : {R"("id": 7)", R"("ok": true)", R"("machine": "press")", R"("role": "engineer")",
                             R"("protocol": 1)", R"("board": "test")"})
        EXPECT_TRUE(has(answer, part));
}

TEST_F(Press, map_provides_the_memory_read_only) {
    ASSERT_TRUE(talker().send("1 map"));
    run(40ms);
    int descriptor = -1;
    EXPECT_TRUE(has(talker().receive(&descriptor), R"("ok": true)"));
    ASSERT_GE(descriptor, 0);
    const auto block = os::map_to_read(descriptor);
    close(descriptor);
    const auto view = map::View::open(block);
    ASSERT_TRUE(view) << view.error().view();
    EXPECT_EQ(view->text(view->header().machine), "press");
    os::unmap(block);
}

TEST_F(Press, get_reads_ports_and_properties_with_their_state) {
    EXPECT_EQ(ask("1 get ram.speed"),
              "{\"id\": 1, \"ok\": true, \"values\": [{\"name\": \"ram.speed\", \"value\": 1}]}\n");
    const std::string answer = ask("2 get ram.limit table.height");
    EXPECT_TRUE(has(answer, R"("name": "ram.limit", "value": 50, "flow": "fresh", "forced": false)"));
    EXPECT_TRUE(has(answer, R"("name": "table.height", "value": 50)"));
    EXPECT_TRUE(has(ask("3 get browser.clients"), R"("value": 1)"));
    EXPECT_TRUE(has(ask("4 get archive.height"), R"("value": 0, "flow": "unread", "forced": false)"));
    EXPECT_TRUE(has(ask("5 get lamp.wanted"), R"("value": false, "flow": "never_written", "forced": false)"));
}

TEST_F(Press, set_changes_several_properties_in_one_transaction) {
    EXPECT_TRUE(has(ask("1 set ram.speed 2.5 ram.force 40"), R"("set": 2)"));
    EXPECT_EQ(ram().speed.get(), 2.5);
    EXPECT_EQ(ram().force.get(), 40);
}

TEST_F(Press, set_changes_nothing_when_one_value_is_wrong) {
    for (const char* request : {"1 set ram.speed 2 ram.force 101", "2 set ram.speed 2 ram.force plenty",
                                "3 set ram.speed 20 ram.force 100", "4 set ram.speed 2 ram.force",
                                "5 set ram.speed 2 browser.log false", "6 set ram.speed nan"}) {
        EXPECT_TRUE(has(ask(request), R"("ok": false)")) << request;
        EXPECT_EQ(ram().speed.get(), 1.0) << request;
        EXPECT_EQ(ram().force.get(), 10.0) << request;
    }
    EXPECT_TRUE(has(ask("7 set ram.speed 20 ram.force 100"), "speed times force is over 100"))
        << "the component's own words";
}

TEST_F(Press, a_forced_output_is_visible_everywhere_and_can_be_released) {
    EXPECT_TRUE(has(ask("1 force table.height 30"), R"("ok": true)"));
    run(50ms);
    EXPECT_EQ(ram().limit.get(), 30.0);
    EXPECT_EQ(instance.observation().forced_ports().load(), 1u);
    EXPECT_TRUE(has(ask("2 get table.height"), R"("value": 30, "flow": "fresh", "forced": true)"));
    EXPECT_TRUE(has(ask("3 forced"), R"("forced": ["table.height"])"));
    EXPECT_TRUE(has(ask("4 force table.height 31"), R"("ok": true)"));
    EXPECT_EQ(instance.observation().forced_ports().load(), 1u) << "forced twice is forced";
    EXPECT_TRUE(has(ask("5 release table.height"), R"("ok": true)"));
    run(50ms);
    EXPECT_EQ(ram().limit.get(), 50.0);
    EXPECT_EQ(instance.observation().forced_ports().load(), 0u);
    EXPECT_TRUE(has(ask("6 forced"), R"("forced": [])"));
}

TEST_F(Press, a_component_reads_its_forced_input) {
    EXPECT_TRUE(has(ask("1 force ram.limit 5"), R"("ok": true)"));
    EXPECT_EQ(ram().limit.get(), 5.0);
    EXPECT_EQ(the<Table>("table").height.last(), 50.0);
    EXPECT_TRUE(has(ask("2 get ram.limit"), R"("value": 5, "flow": "fresh", "forced": true)"));
    EXPECT_TRUE(has(ask("3 release ram.limit"), R"("ok": true)"));
    EXPECT_EQ(ram().limit.get(), 50.0);
}

TEST_F(Press, a_component_stop_ends_forces_on_it_and_publishes_its_safe_value) {
    EXPECT_TRUE(has(ask("1 force ram.place 33"), R"("ok": true)"));
    EXPECT_TRUE(has(ask("2 force ram.limit 5"), R"("ok": true)"));
    EXPECT_TRUE(has(ask("3 stop ram"), R"("ok": true)"));
    EXPECT_TRUE(has(ask("4 get ram.place"), R"("value": 0, "flow": "fresh", "forced": false)"));
    EXPECT_EQ(ram().limit_at_stop, 50.0) << "the forced 5 would hide the last word of whoever writes it";
    EXPECT_EQ(instance.observation().forced_ports().load(), 0u);
    EXPECT_TRUE(has(ask("5 forced"), R"("forced": [])"));
}

TEST_F(Press, a_component_stop_ends_forces_at_its_readers) {
    EXPECT_TRUE(has(ask("1 force ram.limit 5"), R"("ok": true)"));
    EXPECT_TRUE(has(ask("2 stop table"), R"("ok": true)"));
    run(20ms);
    EXPECT_EQ(ram().limit.get(), 50.0) << "what the table left behind";
    EXPECT_EQ(instance.observation().forced_ports().load(), 0u);
    EXPECT_TRUE(has(ask("3 force ram.limit 6"), R"("ok": true)")) << "who wants it again, says so";
    EXPECT_TRUE(has(ask("4 stop activity:slow"), R"("ok": true)"));
    run(20ms);
    EXPECT_EQ(ram().limit.get(), 50.0);
}

TEST_F(Press, an_unrequested_stop_ends_forces_at_its_readers) {
    const std::size_t table = find_component(instance.machine().table, "table");
    for (const LifeChange change : {LifeChange::stop, LifeChange::restart}) {
        EXPECT_TRUE(has(ask("1 force ram.limit 5"), R"("ok": true)"));
        static_cast<void>(instance.life().ask_component(table, change));
        run(60ms);
        EXPECT_EQ(ram().limit.get(), 50.0);
        EXPECT_EQ(instance.observation().forced_ports().load(), 0u);
        static_cast<void>(instance.life().ask_component(table, LifeChange::start));
        run(60ms);
    }
}

TEST_F(Press, a_force_at_the_reader_ends_at_a_stop_without_the_browser) {
    EXPECT_TRUE(has(ask("1 force ram.limit 5"), R"("ok": true)"));
    static_cast<void>(world.change_activity(
        instance.machine().index.activity[find_component(instance.machine().table, "browser")],
        LifeChange::stop));
    static_cast<void>(
        instance.life().ask_component(find_component(instance.machine().table, "table"), LifeChange::stop));
    run(60ms);
    EXPECT_EQ(ram().limit.get(), 50.0);
    EXPECT_EQ(instance.observation().forced_ports().load(), 0u);
}

TEST_F(Press, a_machine_stop_ends_forces_of_already_stopped_components_too) {
    EXPECT_TRUE(has(ask("1 force ram.place 33"), R"("ok": true)"));
    EXPECT_TRUE(has(ask("2 force ram.limit 5"), R"("ok": true)"));
    EXPECT_TRUE(has(ask("3 force table.height 7"), R"("ok": true)"));
    run(20ms);
    EXPECT_EQ(instance.observation().forced_ports().load(), 3u);
    world.stop();
    EXPECT_EQ(ram().place.last(), 0.0);
    EXPECT_EQ(ram().limit_at_stop, 50.0) << "the table, which stops first, ended its force too";
    double seen = -1;
    PortAccess::data<double>.read(&ram().limit, true, true, reinterpret_cast<std::byte*>(&seen));
    EXPECT_EQ(seen, 50.0);
    EXPECT_EQ(instance.observation().forced_ports().load(), 0u);
}

TEST_F(Press, an_impossible_force_is_refused_with_the_reason) {
    EXPECT_TRUE(has(ask("1 force table.parts 3"), "is a buffered port"));
    EXPECT_TRUE(has(ask("2 force ram.speed 3"), "is a property, not an input or an output"));
    EXPECT_TRUE(has(ask("3 force ram.limit far"), R"("code": "bad_value")"));
    EXPECT_EQ(instance.observation().forced_ports().load(), 0u);
}

TEST_F(Press, a_method_runs_in_its_components_engine_and_returns_its_result) {
    EXPECT_TRUE(has(ask("1 call ram.distance 8"), R"("result": 8)"));
    EXPECT_TRUE(has(ask("2 call ram.halt"), R"("ok": true)"));
    EXPECT_TRUE(has(ask("3 call ram.distance"), "takes 1 arguments"));
    EXPECT_TRUE(has(ask("4 call ram.distance far"), R"("code": "bad_value")"));
    EXPECT_TRUE(has(ask("5 call ram.move_to 3"), "is a command"));
}

TEST_F(Press, a_command_is_monitored_until_it_ends) {
    EXPECT_TRUE(has(ask("1 send ram.move_to 40"), R"("ok": true, "state": "sent")"));
    std::vector<std::string> packets;
    for (int i = 0; i < 20; ++i) {
        run(10ms);
        for (std::string each = talker().receive(); !each.empty(); each = talker().receive())
            packets.push_back(each);
    }
    ASSERT_FALSE(packets.empty());
    EXPECT_TRUE(has(packets.front(), R"("command": "ram.move_to")")) << packets.front();
    EXPECT_TRUE(has(packets.back(), R"("state": "done")")) << packets.back();
    EXPECT_TRUE(has(packets.back(), R"("final": true, "results": [1])")) << packets.back();
    EXPECT_EQ(ram().place.last(), 40.0);
}

TEST_F(Press, a_rejected_command_is_reported) {
    EXPECT_TRUE(has(ask("1 send ram.move_to 51"), R"("state": "sent")"));
    run(50ms);
    const std::string packet = talker().receive();
    EXPECT_TRUE(has(packet, R"("state": "rejected")"));
    EXPECT_TRUE(has(packet, R"("final": true)"));
}

TEST_F(Press, a_component_can_be_restarted_while_others_run) {
    EXPECT_TRUE(has(ask("1 stop ram"), R"("ok": true)"));
    EXPECT_EQ(instance.life().state_of(0), ComponentState::stopped);
    EXPECT_EQ(instance.life().state_of(1), ComponentState::running);
    EXPECT_TRUE(has(ask("2 call ram.distance 8"), "does not run; start it first"));
    EXPECT_TRUE(has(ask("3 start ram"), R"("ok": true)"));
    EXPECT_EQ(instance.life().state_of(0), ComponentState::running);
    EXPECT_TRUE(has(ask("4 restart ram"), R"("ok": true)"));
}

TEST_F(Press, an_event_is_reported_to_its_subscribers) {
    Talker other{path()};
    EXPECT_TRUE(has(ask("5 subscribe ram.arrived"), R"("ok": true)"));
    EXPECT_TRUE(has(ask("6 subscribe ram.arrived"), "subscribed to already"));
    EXPECT_TRUE(has(ask(other, "1 send ram.move_to 20"), R"("state": "sent")"));
    run(200ms);
    const std::string event = talker().receive();
    EXPECT_TRUE(has(event, R"({"id": 5, "event": "ram.arrived", "time_ns": )"));
    EXPECT_TRUE(has(event, R"("arguments": [20], "lost": 0})"));
    EXPECT_EQ(talker().receive(), "") << "once";
    EXPECT_TRUE(has(ask("7 unsubscribe ram.arrived"), R"("ok": true)"));
    EXPECT_TRUE(has(ask("8 unsubscribe ram.arrived"), "is not subscribed to"));
    EXPECT_TRUE(other.send("2 send ram.move_to 10"));
    run(200ms);
    EXPECT_EQ(talker().receive(), "");
}

TEST_F(Press, an_event_with_large_arguments_is_reported_unless_too_large) {
    EXPECT_TRUE(has(ask("1 subscribe table.pictured"), "more than the 512 that browsers are told"));
    EXPECT_TRUE(has(ask("2 subscribe table.scanned"), R"("ok": true)"));
    the<Table>("table").scanned.emit({1, 2, 3, 4, 5, 6, 7});
    the<Table>("table").scanned.emit({7, 6, 5, 4, 3, 2, 1});
    run(100ms);
    EXPECT_TRUE(has(talker().receive(), R"("arguments": [[1, 2, 3, 4, 5, 6, 7]])"));
    EXPECT_TRUE(has(talker().receive(), R"("arguments": [[7, 6, 5, 4, 3, 2, 1]])"));
}

TEST_F(Press, a_refusal_is_valid_utf_8_for_any_request) {
    EXPECT_TRUE(has(ask("1 get caf\xc3\xa9\xff.x"), "caf\xc3\xa9?\\\""));
}

TEST_F(Press, the_log_shows_accepted_requests_that_failed_later) {
    the<BrowserService>("browser").log.set(true);
    testing::internal::CaptureStdout();
    ask("1 stop table");
    ask("2 force table.height 7");
    talker().send("3 send ram.move_to -1");
    run(100ms);
    const std::string log = testing::internal::GetCapturedStdout();
    EXPECT_TRUE(has(log, ": 2 force table.height 7\nbrowser: not done (not_now) at "));
    EXPECT_TRUE(has(log, "request 2, engineer: component \"table\" does not run; start it first"));
    EXPECT_TRUE(has(log, "browser: not done (rejected) at "));
}

TEST_F(Press, a_blocking_operation_runs_only_in_an_activity_without_deadline) {
    EXPECT_TRUE(talker().send("1 send archive.store 1"));
    run(100ms);
    const std::string told = talker().receive_all();
    EXPECT_TRUE(has(told, R"("state": "done")"));
    EXPECT_TRUE(has(ask("2 call archive.count"), R"("result": 1)"));
    for (const char* call : {"3 call ram.weigh 30", "4 call ram.survey"}) { // also an any_thread one
        const std::string refused = ask(call);
        EXPECT_TRUE(has(refused, R"("code": "unsupported")"));
        EXPECT_TRUE(has(refused, "may block, and activity \\\"motion\\\" of its component is real-time"));
    }
}

TEST_F(Press, a_force_and_its_end_wake_a_sleeping_reader) {
    const Lamp& lamp = the<Lamp>("lamp");
    EXPECT_TRUE(has(ask("1 force lamp.wanted true"), R"("ok": true)"));
    EXPECT_TRUE(lamp.lit);
    EXPECT_TRUE(has(ask("2 release lamp.wanted"), R"("ok": true)"));
    EXPECT_FALSE(lamp.lit);
}

TEST_F(Press, a_subscriber_receives_events_emitted_while_the_browser_was_stopped) {
    EXPECT_TRUE(has(ask("1 subscribe ram.arrived"), R"("ok": true)"));
    EXPECT_TRUE(has(ask("2 send ram.move_to 20"), R"("state": "sent")"));
    const std::size_t browser = find_component(instance.machine().table, "browser");
    static_cast<void>(instance.life().ask_component(browser, LifeChange::stop));
    run(200ms);
    static_cast<void>(instance.life().ask_component(browser, LifeChange::start));
    run(50ms);
    EXPECT_TRUE(talker().send("3 send ram.move_to 10"));
    run(200ms);
    std::string told;
    for (std::string packet = talker().receive(); !packet.empty(); packet = talker().receive())
        if (has(packet, R"("event")")) told += packet;
    EXPECT_TRUE(has(told, R"("arguments": [10], "lost": 1})"));
    EXPECT_FALSE(has(told, R"("arguments": [20])")) << told;
}

TEST_F(Press, an_event_stays_subscribed_until_the_last_client_leaves) {
    Talker stays{path()};
    Talker leaves{path()};
    EXPECT_TRUE(has(ask(stays, "1 subscribe ram.arrived"), R"("ok": true)"));
    EXPECT_TRUE(has(ask(leaves, "1 subscribe ram.arrived"), R"("ok": true)"));
    leaves.close();
    run(50ms);
    Talker other{path()};
    EXPECT_TRUE(other.send("2 send ram.move_to 10"));
    run(200ms);
    EXPECT_TRUE(has(stays.receive(), R"("event": "ram.arrived")"));
    stays.close();
    run(50ms);
    EXPECT_FALSE(instance.observation().observe_event(0, 2).connected()) << "nobody is left";
}

TEST_F(Press, the_browser_does_not_stop_itself) {
    EXPECT_TRUE(has(ask("1 stop browser"), R"("code": "unsupported")"));
    EXPECT_TRUE(has(ask("2 stop activity:browser"), R"("code": "unsupported")"));
}

TEST_F(Press, an_activity_can_be_restarted_and_is_unchangeable_while_stopped) {
    EXPECT_TRUE(has(ask("1 stop slow"), R"("ok": true)"));
    EXPECT_TRUE(has(ask("2 force table.height 3"), "is stopped"));
    EXPECT_TRUE(has(ask("3 start activity:slow"), R"("ok": true)"));
    EXPECT_TRUE(has(ask("4 force table.height 3"), R"("ok": true)"));
}

TEST_F(Press, wrong_names_are_refused_with_the_right_ones) {
    EXPECT_TRUE(has(ask("1 get ram.sped"), R"(did you mean \"speed\"?)"));
    EXPECT_TRUE(has(ask("2 get rum.speed"), R"(did you mean \"ram\"?)"));
    EXPECT_TRUE(has(ask("3 get speed"), R"(write \"component.facet\")"));
    EXPECT_TRUE(has(ask("4 hallo"), R"(did you mean \"hello\"?)"));
    EXPECT_TRUE(has(ask("5 stop motoin"), R"(did you mean \"motion\"?)"));
}

TEST_F(Press, an_invalid_request_is_refused_and_the_next_is_served) {
    for (const std::string& packet :
         {std::string{"hello"}, std::string{"1"}, std::string{"-1 hello"}, std::string{"99999999999 hello"},
          std::string{"1 get \"ram"}, std::string{"1 get [1, 2"}, std::string{"1 hello\x01"},
          std::string(5000, 'x'), std::string{"1 get"}, std::string{"1 hello you"}, std::string(4000, '1')}) {
        const std::string answer = ask(packet);
        EXPECT_TRUE(has(answer, R"("code": "bad_request")")) << packet.substr(0, 40);
        EXPECT_TRUE(has(answer, R"("error": ")"));
    }
    EXPECT_TRUE(has(ask("8 hello"), R"("id": 8, "ok": true)"));
    EXPECT_EQ(the<BrowserService>("browser").refused.last(), 11);
}

} // namespace
} // namespace tappet::press
