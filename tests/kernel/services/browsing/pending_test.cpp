// What a request does inside the machine: not over a component that has stopped, and not after its client was
// told that nothing was done.
#include "kernel/services/browsing/pending.hpp"
#include "tests/kernel/services/browsing/press_rig.hpp"

namespace tappet::press {
namespace {

constexpr std::size_t motion = 0;
constexpr std::string_view left_safe = R"(does not run; start it first)";

TEST_F(Press, nothing_is_forced_over_what_a_stopped_component_left_behind_while_its_activity_goes_on) {
    Talker talker{path()};
    EXPECT_TRUE(has(ask(talker, "1 stop table"), R"("ok": true)"));
    EXPECT_TRUE(has(ask(talker, "2 force table.height 7"), left_safe));
    EXPECT_TRUE(has(ask(talker, "3 get table.height"), R"("value": 50, "flow": "fresh", "forced": false)"));
    EXPECT_EQ(instance.observation().forced_ports().load(), 0u);
    EXPECT_TRUE(has(ask(talker, "4 force shelf.height 7"), R"("ok": true)")) << "that one runs";
    EXPECT_TRUE(has(ask(talker, "5 start table"), R"("ok": true)"));
    EXPECT_TRUE(has(ask(talker, "6 force table.height 7"), R"("ok": true)"));
}

TEST_F(Press, nothing_is_forced_that_was_asked_for_in_the_moment_of_the_stop) {
    Talker talker{path()};
    for (const char* request : {"1 stop ram", "2 force ram.place 33", "3 force ram.limit 5"})
        ASSERT_TRUE(talker.send(request));
    run(50ms);
    std::string answers;
    for (std::string each = talker.receive(); !each.empty(); each = talker.receive()) answers += each;
    EXPECT_TRUE(has(answers, R"("id": 1, "ok": true)")) << answers;
    for (const char* refused : {R"("id": 2, "ok": false)", R"("id": 3, "ok": false)"})
        EXPECT_TRUE(has(answers, refused)) << answers;
    EXPECT_TRUE(has(answers, left_safe)) << answers;
    EXPECT_EQ(ram().place.last(), 0.0);
    EXPECT_TRUE(has(ask(talker, "4 get ram.place"), R"("value": 0, "flow": "fresh", "forced": false)"));
    EXPECT_TRUE(has(ask(talker, "5 get ram.limit"), R"("forced": false)"));
    EXPECT_EQ(instance.observation().forced_ports().load(), 0u);
}

TEST_F(Press, a_request_that_its_client_was_told_is_not_done_is_not_done_later_either) {
    Engine& engine = instance.engines()[motion];
    engine.stop(clock.now());
    engine.plan().parts[0].state.store(ComponentState::running); // as of a thread that does not come
    Talker talker{path()};
    EXPECT_TRUE(has(ask(talker, "1 call ram.let_go", 3s), "its engine did not come to it; nothing was done"));
    engine.start(clock.now());
    run(100ms);
    EXPECT_EQ(ram().let_goes, 0);
    EXPECT_TRUE(has(ask(talker, "2 call ram.let_go"), R"("ok": true)"));
    EXPECT_EQ(ram().let_goes, 1);
}

TEST_F(Press, requests_that_nobody_came_to_free_their_places_when_their_engine_comes) {
    Engine& engine = instance.engines()[motion];
    engine.stop(clock.now());
    engine.plan().parts[0].state.store(ComponentState::running);
    Talker talker{path()};
    for (std::size_t i = 0; i < BrowserService::max_pending; ++i)
        EXPECT_TRUE(has(ask(talker, "1 call ram.let_go", 3s), "did not come to it"));
    EXPECT_TRUE(has(ask(talker, "2 call ram.let_go"), "too many requests are under way"));
    engine.start(clock.now());
    run(100ms);
    EXPECT_TRUE(has(ask(talker, "3 call ram.let_go"), R"("ok": true)"));
    EXPECT_EQ(ram().let_goes, 1);
}

/// Counts how often it ran; may try to take itself back meanwhile.
struct AnEngineCall : Press {
    EngineCall call{};
    int runs = 0;
    bool takes_itself_back = false, was_taken_back = false;

    void post(bool itself_back) {
        takes_itself_back = itself_back;
        Message message;
        message.object = this;
        message.run = [](void* self, const std::byte*) noexcept TAPPET_REALTIME {
            auto& test = *static_cast<AnEngineCall*>(self);
            ++test.runs;
            if (test.takes_itself_back) test.was_taken_back = test.call.withdraw();
        };
        ASSERT_TRUE(call.post(instance, motion, message));
    }
};

TEST_F(AnEngineCall, that_was_withdrawn_in_time_does_nothing_and_is_over_when_its_engine_came_to_it) {
    post(false);
    EXPECT_TRUE(call.withdraw());
    EXPECT_FALSE(call.is_over()) << "it still lies in the mailbox";
    EXPECT_FALSE(call.withdraw()) << "once";
    run(10ms);
    EXPECT_EQ(runs, 0);
    EXPECT_TRUE(call.is_over());
}

TEST_F(AnEngineCall, that_was_withdrawn_too_late_was_done_and_stays_over) {
    post(false);
    run(10ms);
    EXPECT_EQ(runs, 1);
    EXPECT_FALSE(call.withdraw());
    EXPECT_TRUE(call.is_over());
}

TEST_F(AnEngineCall, that_is_withdrawn_while_it_runs_is_done_and_over) {
    post(true);
    run(10ms);
    EXPECT_EQ(runs, 1);
    EXPECT_FALSE(was_taken_back);
    EXPECT_TRUE(call.is_over());
}

} // namespace
} // namespace tappet::press
