// Users of a gateway (thesis 4.8): the machine bounds their roles, names them in its log, and refuses over
// the network what moves something, whatever the gateway says.
#include "tests/kernel/services/browsing/press_rig.hpp"

#include "kernel/services/browsing/access.hpp"

#include <gmock/gmock.h>

#include <memory>

namespace tappet::press {
namespace {

constexpr uid_t bounded_gateway = 990; ///< up to operators
constexpr uid_t panel_gateway = 991;   ///< up to engineers, with a panel
constexpr uid_t unlisted = 65534;

class Gateway : public Press {
protected:
    void SetUp() override {
        if (geteuid() != 0) GTEST_SKIP() << "only root can connect as somebody else";
        Press::SetUp();
    }
    /// Connects as that user, and asks for somebody. Expects the role.
    Talker as(uid_t user, const std::string& who, std::string_view role) {
        Talker made{path(), user};
        const std::string expected = R"("role": ")" + std::string{role} + "\"";
        EXPECT_TRUE(has(ask(made, "1 as " + who), expected)) << who;
        EXPECT_TRUE(has(ask(made, "2 hello"), expected)) << who;
        return made;
    }
    /// Returns the lines that the service prints meanwhile.
    template <class Ask> std::string log_of(const Ask& asks) {
        EXPECT_TRUE(has(ask("90 set browser.log true"), R"("ok": true)"));
        testing::internal::CaptureStdout();
        testing::internal::CaptureStderr();
        asks();
        return testing::internal::GetCapturedStdout() + testing::internal::GetCapturedStderr();
    }
};

TEST_F(Gateway, users_have_the_lowest_of_three_roles) {
    as(bounded_gateway, "ann engineer network", "operator");
    as(bounded_gateway, "ann operator network", "operator");
    as(bounded_gateway, "ann observer network", "observer");
    as(panel_gateway, "ann engineer panel", "engineer");
    as(1001, "ann engineer network", "operator");
    as(unlisted, "ann engineer panel", "observer");
    as(0, "ann operator network", "operator");
}

TEST(GatewayRows, bound_replaces_any_other_role_and_the_lowest_one_holds) {
    constexpr BoardBrowsing board{.roles = roles(group(50, Role::engineer),
                                                 gateway(user(990), up_to(Role::machine_operator)),
                                                 gateway(group(51), up_to(Role::observer)))};
    const auto peer = [](std::uint32_t user, std::uint32_t group) { return os::Peer{1, user, group, {}}; };
    EXPECT_EQ(browsing::role_of(peer(990, 50), board), Role::machine_operator);
    EXPECT_EQ(browsing::role_of(peer(990, 51), board), Role::observer);
    EXPECT_EQ(browsing::role_of(peer(4242, 51), board), Role::observer);
    EXPECT_EQ(browsing::role_of(peer(4242, 50), board), Role::engineer);
    constexpr BoardBrowsing own{.roles = roles(gateway(group(77), up_to(Role::machine_operator)))};
    EXPECT_EQ(browsing::role_of(peer(os::own_user(), 77), own), Role::machine_operator)
        << "the machine's own user is no exception";
}

TEST_F(Gateway, answers_nothing_before_its_user_is_named) {
    Talker gateway{path(), bounded_gateway};
    EXPECT_TRUE(has(ask(gateway, "1 hello"), R"("role": "observer")"));
    for (const char* request : {"2 map", "3 get ram.place", "4 subscribe ram.arrived", "5 call ram.halt"}) {
        const std::string answer = ask(gateway, request);
        EXPECT_TRUE(has(answer, R"("code": "denied")"));
        EXPECT_TRUE(has(answer, "this connection asks for a user whom it has not named")) << request;
    }
    EXPECT_TRUE(has(ask(gateway, "6 as ann operator network"), R"("role": "operator")"));
    EXPECT_TRUE(has(ask(gateway, "7 get ram.place"), R"("ok": true)"));
}

TEST_F(Gateway, user_is_named_once_and_first) {
    Talker named = as(panel_gateway, "ann observer network", "observer");
    EXPECT_TRUE(has(ask(named, "3 as ann engineer panel"), "comes once; connect anew"));
    EXPECT_TRUE(has(ask(named, "4 hello"), R"("role": "observer")"));
    Talker late{path()};
    EXPECT_TRUE(has(ask(late, "1 get ram.place"), R"("ok": true)"));
    EXPECT_TRUE(has(ask(late, "2 as ann observer network"), "is the first request of a connection"));
    EXPECT_TRUE(has(ask(late, "3 hello"), R"("role": "engineer")"));
}

TEST_F(Gateway, wrong_user_is_refused_and_nobody_is_asked_for) {
    const std::string longest(browsing::max_user_characters, 'x');
    as(bounded_gateway, longest + " operator network", "operator");
    for (const uid_t peer : {uid_t{0}, bounded_gateway}) {
        Talker talker{path(), peer};
        for (const std::string& who :
             {std::string{"Ann operator network"}, longest + "x operator network",
              std::string{"\"\" operator network"}, std::string{"a/b operator network"},
              std::string{"ann root network"}, std::string{"ann operator local"}, std::string{"ann operator"},
              std::string{"ann operator network now"}})
            EXPECT_TRUE(has(ask(talker, "1 as " + who), R"("ok": false)")) << who;
        EXPECT_TRUE(has(ask(talker, "2 set ram.speed 3"), "begin with"))
            << "it is not a local connection again";
        EXPECT_TRUE(has(ask(talker, "3 as ann operator network"), R"("role": "operator")"));
    }
    EXPECT_EQ(ram().speed.get(), 1.0);
}

TEST_F(Gateway, panel_needs_the_board_s_word) {
    Talker without{path(), bounded_gateway};
    EXPECT_TRUE(has(ask(without, "1 as ann operator panel"), "this gateway has no panel; add with_panel"));
    EXPECT_TRUE(has(ask(without, "2 call ram.halt"), R"("code": "denied")"));
    Talker panel = as(panel_gateway, "ann operator panel", "operator");
    EXPECT_TRUE(has(ask(panel, "3 send ram.move_to 3"), R"("state": "sent")"));
    while (!next(panel).empty()) {
    }
    EXPECT_TRUE(has(ask(panel, "4 call ram.creep"), R"("ok": true)"));
}

TEST_F(Gateway, network_asks_for_nothing_that_moves_and_for_nothing_unmarked) {
    for (const uid_t peer : {uid_t{0}, panel_gateway}) {
        Talker remote = as(peer, "ann engineer network", "engineer");
        const auto refused = [&](std::string_view request, std::string_view why) {
            const std::string answer = ask(remote, request);
            EXPECT_TRUE(has(answer, R"("code": "denied")"));
            EXPECT_TRUE(has(answer, why));
        };
        refused("3 send ram.move_to 3", R"(\"ram.move_to\" moves something, so nobody may ask for it)");
        refused("4 call ram.creep", R"(\"ram.creep\" moves something while it is held)");
        refused("5 call ram.let_go", R"(\"ram.let_go\" is not for people, so nobody may ask for it)");
        refused("6 call ram.distance 3", R"(is not for people)");
        EXPECT_TRUE(has(ask(remote, "7 call ram.halt"), R"("ok": true)"));
        EXPECT_TRUE(has(ask(remote, "8 set ram.speed 1.5"), R"("ok": true)"));
    }
    EXPECT_EQ(ram().target, 0);
    EXPECT_EQ(ram().let_goes, 0);
    Talker local{path()};
    EXPECT_TRUE(has(ask(local, "1 send ram.move_to 3"), R"("state": "sent")")) << "at the machine, as ever";
}

TEST_F(Gateway, user_stands_in_each_line_of_the_log) {
    Talker remote = as(bounded_gateway, "ann.b engineer network", "operator");
    const std::string log = log_of([&] {
        static_cast<void>(ask(remote, "3 call ram.halt"));
        static_cast<void>(ask(remote, "4 send ram.move_to 3"));
        remote.close();
        run(40ms);
    });
    EXPECT_THAT(
        log, testing::ContainsRegex("accepted at .*, uid 990, pid [0-9]+, operator ann.b from the network: "
                                    "3 call ram.halt"));
    EXPECT_THAT(log,
                testing::ContainsRegex("refused .denied. at .*operator ann.b from the network: 4 send ram"));
    EXPECT_THAT(log, testing::ContainsRegex("left at .*operator ann.b from the network"));
}

TEST_F(Gateway, user_stands_in_the_line_of_what_was_not_done) {
    Talker panel = as(panel_gateway, "ann operator panel", "operator");
    const std::string log = log_of([&] {
        static_cast<void>(ask(panel, "3 send ram.move_to 4000")); // beyond the limit
        run(100ms);
    });
    EXPECT_THAT(log, testing::ContainsRegex("not done .rejected. at .*request 3, operator ann: ram.move_to"));
}

TEST_F(Gateway, new_connection_takes_nobody_s_place) {
    std::vector<std::unique_ptr<Talker>> observers;
    for (std::size_t i = 0; i < browsing::max_clients; ++i)
        observers.push_back(std::make_unique<Talker>(path(), unlisted));
    run(40ms);
    Talker gateway{path(), panel_gateway};
    run(40ms);
    EXPECT_TRUE(has(gateway.receive(), "places are taken"));
    for (const auto& each : observers) EXPECT_TRUE(has(ask(*each, "1 hello"), R"("ok": true)"));
}

TEST_F(Gateway, observer_does_not_block_the_other_users_of_his_gateway) {
    std::vector<std::unique_ptr<Talker>> idle;
    for (std::size_t i = 0; i < browsing::max_clients; ++i) {
        idle.push_back(std::make_unique<Talker>(path(), panel_gateway));
        EXPECT_TRUE(has(ask(*idle.back(), "1 as eve observer network"), "observer"));
    }
    as(panel_gateway, "mary engineer network", "engineer");
    EXPECT_TRUE(has(idle.front()->receive(), "another user of your gateway needs this place"));
    EXPECT_TRUE(has(ask(*idle[1], "2 hello"), R"("ok": true)"));
}

} // namespace
} // namespace tappet::press
