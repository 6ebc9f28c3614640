// Access rights and the limits of a client (thesis 4.8): roles by the board's list, a share of each cycle for
// every client, and no effect of one client on another.
#include "tests/kernel/services/browsing/press_rig.hpp"

#include "kernel/services/browsing/access.hpp"

#include <memory>
#include <vector>

namespace tappet::press {
namespace {

os::Peer peer(std::uint32_t user, std::uint32_t main_group,
              std::initializer_list<std::uint32_t> groups = {}) {
    os::Peer made{1, user, main_group, {}};
    for (const std::uint32_t each : groups) static_cast<void>(made.groups.push(each));
    return made;
}

constexpr BoardBrowsing listed{.directory = "/run/tappet",
                               .roles = roles(user(1001, Role::machine_operator), group(50, Role::engineer),
                                              group(60, Role::machine_operator))};

TEST(Access, root_and_the_user_of_the_machine_are_engineers) {
    EXPECT_EQ(browsing::role_of(peer(0, 0), {}), Role::engineer);
    EXPECT_EQ(browsing::role_of(peer(os::own_user(), 77), {}), Role::engineer);
}

TEST(Access, an_unlisted_user_observes) {
    EXPECT_EQ(browsing::role_of(peer(4242, 4242), listed), Role::observer);
}

TEST(Access, the_board_lists_users_and_groups_and_the_highest_role_applies) {
    EXPECT_EQ(browsing::role_of(peer(1001, 4242), listed), Role::machine_operator);
    EXPECT_EQ(browsing::role_of(peer(4242, 60), listed), Role::machine_operator);
    EXPECT_EQ(browsing::role_of(peer(4242, 4242, {60, 50}), listed), Role::engineer);
    EXPECT_EQ(browsing::role_of(peer(1001, 4242, {50}), listed), Role::engineer);
    EXPECT_EQ(browsing::role_of(peer(50, 1001), listed), Role::observer) << "a user is no group";
}

TEST(Access, observers_read_operators_act_and_engineers_change) {
    for (const browsing::VerbRow& row : browsing::verbs) {
        const bool looks = row.name == "hello" || row.name == "map" || row.name == "get" ||
                           row.name == "forced" || row.name == "subscribe" || row.name == "unsubscribe" ||
                           row.name == "behaviours" || row.name == "counters" || row.name == "why" ||
                           row.name == "as" || row.name == "execute"; // statements need more
        const bool acts = row.name == "call" || row.name == "send" || row.name == "break_off";
        EXPECT_EQ(row.role, looks  ? Role::observer
                            : acts ? Role::machine_operator
                                   : Role::engineer)
            << row.name;
    }
}

TEST_F(Press, observers_leave_subscriptions_for_higher_roles) {
    if (geteuid() != 0) GTEST_SKIP() << "only root can connect as somebody else";
    std::vector<std::unique_ptr<Talker>> observers;
    std::size_t taken = 0, refused = 0;
    for (int n = 0; n < 6; ++n) {
        ASSERT_EQ(seteuid(65534), 0);
        observers.push_back(std::make_unique<Talker>(path()));
        ASSERT_EQ(seteuid(0), 0);
        for (const char* request :
             {"1 subscribe ram.arrived", "2 subscribe table.scanned", "3 subscribe shelf.scanned"})
            ++(has(ask(*observers.back(), request), R"("ok": true)") ? taken : refused);
    }
    EXPECT_EQ(taken, BrowserService::max_subscriptions / 2);
    EXPECT_GT(refused, 0u);
    Talker engineer{path()};
    EXPECT_TRUE(has(ask(engineer, "4 subscribe ram.arrived"), R"("ok": true)"));
}

TEST_F(Press, a_request_without_the_role_is_refused_and_has_no_effect) {
    if (geteuid() != 0) GTEST_SKIP() << "only root can connect as somebody else";
    // The identity of the peer is fixed when it connects.
    Talker talker{path(), 65534};
    EXPECT_TRUE(has(ask(talker, "1 hello"), R"("role": "observer")"));
    const std::string answer = ask(talker, "2 set ram.speed 3");
    EXPECT_TRUE(has(answer, R"("code": "denied")"));
    EXPECT_TRUE(has(answer, R"(\"set\" needs the role of an engineer, you are an observer)"));
    EXPECT_EQ(ram().speed.get(), 1.0);
    EXPECT_TRUE(has(ask(talker, "3 send ram.move_to 3"), R"("code": "denied")"));
    EXPECT_TRUE(has(ask(talker, "4 stop ram"), R"("code": "denied")"));
    EXPECT_TRUE(has(ask(talker, "5 get ram.speed"), R"("ok": true)"));
}

TEST_F(Press, an_operator_may_call_only_operator_facets) {
    if (geteuid() != 0) GTEST_SKIP() << "only root can connect as somebody else";
    Talker talker{path(), 1001};
    EXPECT_TRUE(has(ask(talker, "1 hello"), R"("role": "operator")"));
    EXPECT_TRUE(has(ask(talker, "2 call ram.halt"), R"("ok": true)"));
    EXPECT_TRUE(has(ask(talker, "3 send ram.move_to 10"), R"("state": "sent")"));
    run(100ms);
    while (!talker.receive().empty()) {
    }
    const std::string answer = ask(talker, "4 call ram.let_go");
    EXPECT_TRUE(has(answer, R"("code": "denied")"));
    EXPECT_TRUE(has(answer, R"(\"ram.let_go\" needs the role of an engineer, you are an operator)"));
    EXPECT_EQ(ram().let_goes, 0);
    EXPECT_TRUE(has(ask(talker, "5 call ram.distance 3"), R"("code": "denied")"));
    Talker engineer{path()};
    EXPECT_TRUE(has(ask(engineer, "1 call ram.let_go"), R"("ok": true)"));
    EXPECT_EQ(ram().let_goes, 1);
}

TEST_F(Press, a_flooding_client_gets_only_its_share) {
    Talker flood{path()};
    Talker quiet{path()};
    run(40ms);
    auto& service = the<BrowserService>("browser");
    std::size_t sent = 0;
    while (flood.send("1 get ram.speed") && sent < 100'000) ++sent;
    EXPECT_LT(sent, 100'000u) << "its own socket fills";
    const std::int64_t before = service.requests.last();
    run(100ms);
    EXPECT_LE(service.requests.last() - before,
              static_cast<std::int64_t>(6 * browsing::Connections::packets_each_cycle));
    EXPECT_TRUE(has(ask(quiet, "2 hello", 40ms), R"("ok": true)")) << "the other one does not wait for it";
}

TEST_F(Press, a_client_that_does_not_read_loses_its_own_packets_with_notice) {
    Talker deaf{path()};
    for (int i = 0; i < 3000; ++i) {
        static_cast<void>(deaf.send("1 get ram.place ram.limit ram.speed table.height"));
        if (i % 4 == 3) run(20ms);
    }
    run(100ms);
    std::string last;
    for (std::string each = deaf.receive(); !each.empty(); each = deaf.receive()) last = each;
    EXPECT_TRUE(has(ask(deaf, "2 hello"), R"("dropped": )"));
    EXPECT_FALSE(has(ask(deaf, "3 hello"), R"("dropped")")) << "told once";
}

TEST_F(Press, an_excess_client_is_refused_and_the_others_stay) {
    std::vector<std::unique_ptr<Talker>> talkers;
    for (std::size_t i = 0; i < browsing::max_clients; ++i)
        talkers.push_back(std::make_unique<Talker>(path()));
    run(40ms);
    Talker late{path()};
    run(40ms);
    EXPECT_TRUE(has(late.receive(), "places are taken"));
    EXPECT_TRUE(late.gone());
    EXPECT_TRUE(has(ask(*talkers.back(), "1 hello"), R"("ok": true)"));
    talkers.front()->close();
    run(40ms);
    Talker next{path()};
    EXPECT_TRUE(has(ask(next, "1 hello"), R"("ok": true)")) << "a place that was left is given again";
}

/// Connected as a user that the board does not list.
std::unique_ptr<Talker> observer(const std::string& path) { return std::make_unique<Talker>(path, 65534); }

TEST_F(Press, a_higher_role_replaces_the_longest_idle_client_of_a_lower_one) {
    if (geteuid() != 0) GTEST_SKIP() << "only root can connect as somebody else";
    std::vector<std::unique_ptr<Talker>> observers;
    for (std::size_t i = 0; i < browsing::max_clients; ++i) observers.push_back(observer(path()));
    run(40ms);
    EXPECT_TRUE(has(ask(*observers[0], "1 hello"), R"("role": "observer")")) << "it is idle no longer";
    Talker engineer{path()};
    EXPECT_TRUE(has(ask(engineer, "1 hello"), R"("role": "engineer")"));
    EXPECT_TRUE(has(observers[1]->receive(), "an engineer needs this place"));
    EXPECT_TRUE(observers[1]->gone());
    for (const std::size_t each : {0u, 2u, 7u})
        EXPECT_TRUE(has(ask(*observers[each], "2 hello"), R"("ok": true)")) << each << " stays";
    const auto late = observer(path());
    run(40ms);
    EXPECT_TRUE(has(late->receive(), "places are taken")) << "one of no higher role does not";
    EXPECT_TRUE(has(ask(engineer, "2 set ram.speed 3"), R"("ok": true)"));
}

TEST_F(Press, idle_unaccepted_observers_do_not_block_other_clients) {
    if (geteuid() != 0) GTEST_SKIP() << "only root can connect as somebody else";
    std::vector<std::unique_ptr<Talker>> crowd;
    for (int round = 0; round < 3; ++round) {
        for (std::size_t i = 0; i < browsing::max_clients; ++i) crowd.push_back(observer(path()));
        run(20ms); // one cycle handles all that wait
    }
    EXPECT_TRUE(has(crowd.back()->receive(), "places are taken"));
    Talker engineer{path()};
    EXPECT_TRUE(has(ask(engineer, "1 hello"), R"("role": "engineer")"));
}

TEST_F(Press, a_client_that_dies_leaves_nothing_behind) {
    for (int i = 0; i < 40; ++i) {
        Talker talker{path()};
        for (const char* request : {"1 send ram.move_to 40", "2 set ram.speed 1", "3 call ram.distance 1"})
            EXPECT_TRUE(talker.send(request));
        run(20ms);
        talker.close();
        run(20ms);
    }
    run(200ms);
    Talker talker{path()};
    EXPECT_TRUE(has(ask(talker, "1 send ram.move_to 10"), R"("state": "sent")"));
    Talker other{path()};
    EXPECT_TRUE(has(ask(other, "2 set ram.speed 2"), R"("set": 1)"));
}

TEST(Access, a_machine_without_a_directory_runs_without_a_socket) {
    PlacedRig<table, board> rig;
    MachineInstance& instance = rig.instance;
    ASSERT_TRUE(instance.browsing_directory().empty()) << "the board names none";
    PropertyFiles none{{}};
    instance.read_properties_from(none.store());
    ASSERT_TRUE(instance.configure({}));
    rig.world.start();
    EXPECT_TRUE(rig.run(1s));
    EXPECT_EQ(rig.the<BrowserService>("browser").requests.last(), 0);
}

} // namespace
} // namespace tappet::press
