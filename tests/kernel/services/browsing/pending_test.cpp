// The effect of a request inside the machine: none on a stopped component, and none after its client was told
// that nothing was done.
#include "kernel/services/browsing/pending.hpp"
#include "tests/kernel/services/browsing/press_rig.hpp"

namespace tappet::press {
namespace {

constexpr std::size_t motion = 0;
constexpr std::string_view left_safe = R"(does not run; start it first)";

TEST_F(Press, the_safe_value_of_a_stopped_component_cannot_be_forced) {
    EXPECT_TRUE(has(ask("1 stop table"), R"("ok": true)"));
    EXPECT_TRUE(has(ask("2 force table.height 7"), left_safe));
    EXPECT_TRUE(has(ask("3 get table.height"), R"("value": 50, "flow": "fresh", "forced": false)"));
    EXPECT_EQ(instance.observation().forced_ports().load(), 0u);
    EXPECT_TRUE(has(ask("4 force shelf.height 7"), R"("ok": true)")) << "that one runs";
    EXPECT_TRUE(has(ask("5 start table"), R"("ok": true)"));
    EXPECT_TRUE(has(ask("6 force table.height 7"), R"("ok": true)"));
}

TEST_F(Press, a_force_at_the_reader_ends_at_a_stop_despite_pending_commands) {
    ask("1 force ram.limit 40");
    ask("2 set ram.speed 0.1");
    for (std::size_t i = 0; i < BrowserService::max_pending; ++i)
        ASSERT_TRUE(talker().send(std::to_string(10 + i) + " send ram.move_to " + std::to_string(22 + i)));
    run(100ms);
    ram().target = 1; // none of them ends
    run(100ms);
    instance.life().ask_component(find_component(instance.machine().table, "table"), LifeChange::stop);
    run(1s);
    EXPECT_EQ(instance.observation().forced_ports().load(), 0u) << "who reads it lets go";
}

TEST_F(Press, endless_commands_leave_slots_for_the_requests_that_end_them) {
    {
        Talker talker{path()};
        ask(talker, "1 set ram.speed 0.1");
        for (std::size_t i = 0; i < 2 * BrowserService::max_pending; ++i) // to targets that it never reaches
            ASSERT_TRUE(
                talker.send(std::to_string(10 + i) + " send ram.move_to " + std::to_string(i) + ".037"));
        run(200ms);
    }
    Talker other{path()};
    EXPECT_TRUE(has(ask(other, "1 call ram.distance 8"), R"("ok": true)"));
    EXPECT_THAT(ask(other, "2 send ram.move_to 5"), testing::HasSubstr("too many commands are under way"));
    EXPECT_THAT(ask(other, "3 stop ram"), testing::HasSubstr(R"("ok": true)"));
    run(100ms);
    EXPECT_THAT(ask(other, "4 start ram"), testing::HasSubstr(R"("ok": true)"));
    EXPECT_THAT(ask(other, "5 send ram.move_to 5"), testing::HasSubstr(R"("state": "sent")"));
}

TEST_F(Press, operator_commands_leave_slots_for_engineers) {
    Talker engineer{path()};
    ask(engineer, "1 set ram.speed 0.1");
    {
        Talker worker{path(), 1001};
        for (std::size_t i = 0; i < 2 * BrowserService::max_pending; ++i)
            ASSERT_TRUE(
                worker.send(std::to_string(10 + i) + " send ram.move_to " + std::to_string(i) + ".037"));
        run(200ms);
    }
    EXPECT_THAT(ask(engineer, "2 send ram.move_to 5"), testing::HasSubstr(R"("state": "sent")"));
}

TEST_F(Press, a_force_requested_during_the_stop_has_no_effect) {
    for (const char* request : {"1 stop ram", "2 force ram.place 33", "3 force ram.limit 5"})
        ASSERT_TRUE(talker().send(request));
    run(50ms);
    const std::string answers = talker().receive_all();
    EXPECT_TRUE(has(answers, R"("id": 1, "ok": true)"));
    for (const char* refused : {R"("id": 2, "ok": false)", R"("id": 3, "ok": false)"})
        EXPECT_TRUE(has(answers, refused));
    EXPECT_TRUE(has(answers, left_safe));
    EXPECT_EQ(ram().place.last(), 0.0);
    EXPECT_TRUE(has(ask("4 get ram.place"), R"("value": 0, "flow": "fresh", "forced": false)"));
    EXPECT_TRUE(has(ask("5 get ram.limit"), R"("forced": false)"));
    EXPECT_EQ(instance.observation().forced_ports().load(), 0u);
}

TEST_F(Press, a_request_reported_as_not_done_is_never_done_later) {
    Engine& engine = hang(motion);
    EXPECT_TRUE(has(ask("1 call ram.let_go", 3s), "its engine did not execute it in time; nothing was done"));
    engine.start(clock.now());
    run(100ms);
    EXPECT_EQ(ram().let_goes, 0);
    EXPECT_TRUE(has(ask("2 call ram.let_go"), R"("ok": true)"));
    EXPECT_EQ(ram().let_goes, 1);
}

TEST_F(Press, requests_to_a_hung_engine_do_not_block_other_requests) {
    Engine& engine = hang(motion);
    Talker talker{path()}, other{path()};
    for (std::size_t i = 0; i < 3 * BrowserService::max_pending; ++i) {
        for (std::size_t k = 0; k < 4; ++k) ASSERT_TRUE(talker.send("1 call ram.let_go"));
        EXPECT_TRUE(has(ask(other, "2 force shelf.height 7"), R"("ok": true)")) << "after " << i;
        run(3s);
    }
    std::size_t answers = 0;
    for (std::string each = talker.receive(); !each.empty(); each = talker.receive(), ++answers)
        EXPECT_TRUE(has(each, "did not execute it in time; nothing was done") ||
                    has(each, "too many requests to serve"));
    EXPECT_EQ(answers, 12 * BrowserService::max_pending) << "each is told";
    engine.start(clock.now());
    run(100ms);
    EXPECT_EQ(ram().let_goes, 0) << "nothing that was called not done is done later";
    EXPECT_TRUE(has(ask(talker, "3 call ram.let_go"), R"("ok": true)"));
    EXPECT_EQ(ram().let_goes, 1);
}

TEST_F(Press, a_request_to_a_stopped_activity_is_refused_at_once) {
    Engine& engine = instance.engines()[motion];
    engine.stop(clock.now());
    engine.plan().parts[0].state.store(ComponentState::failed);
    EXPECT_TRUE(has(ask("1 set ram.speed 3"), "is stopped, and nothing of it can be changed"));
}

/// Counts its runs; may try to withdraw itself meanwhile.
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
        ASSERT_TRUE(call.post(instance, motion, message, Role::engineer));
    }
};

TEST_F(AnEngineCall, does_nothing_when_withdrawn_in_time_and_can_be_posted_again) {
    for (int i = 0; i < 3; ++i) {
        post(false);
        EXPECT_FALSE(call.is_over());
        EXPECT_TRUE(call.withdraw());
        EXPECT_TRUE(call.is_over()) << "though it still lies in the mailbox";
        EXPECT_FALSE(call.withdraw()) << "once";
    }
    post(false);
    run(10ms);
    EXPECT_EQ(runs, 1) << "the last one";
    EXPECT_TRUE(call.is_over());
}

TEST_F(AnEngineCall, stays_complete_when_withdrawn_too_late) {
    post(false);
    run(10ms);
    EXPECT_EQ(runs, 1);
    EXPECT_FALSE(call.withdraw());
    EXPECT_TRUE(call.is_over());
}

TEST_F(AnEngineCall, completes_when_withdrawn_while_it_runs) {
    post(true);
    run(10ms);
    EXPECT_EQ(runs, 1);
    EXPECT_FALSE(was_taken_back);
    EXPECT_TRUE(call.is_over());
}

} // namespace
} // namespace tappet::press
