// A client's session: login, watches with their frames, and requests with the log.
#include "tests/toolchain/tools/gateway/rig.hpp"

#include <gmock/gmock.h>

#include <cstring>

namespace tappet::network {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

template <class Number> Number at(const std::string& frame, std::size_t place) {
    Number number{};
    EXPECT_LE(place + sizeof number, frame.size());
    std::memcpy(&number, frame.data() + place, sizeof number);
    return number;
}

class Session : public testing::Test {
protected:
    void say(std::string_view text) { peer->receive(text, rig.now); }
    nlohmann::json last() { return client.texts.empty() ? nlohmann::json{} : client.texts.back(); }
    /// Lets the machine accept the connection.
    void accept() { rig.line.receive(R"({"id": 4294967295, "ok": true, "role": "engineer"})"); }

    Rig rig{};
    Client client{};
    std::shared_ptr<Peer> peer = rig.join(client);
};

TEST_F(Session, lists_machines_and_facets) {
    say(R"({"id": 1, "do": "machines"})");
    EXPECT_EQ(last()["machines"][0]["name"], "sample");
    EXPECT_EQ(last()["machines"][0]["answers"], true);
    say(R"({"id": 2, "do": "facets", "machine": "sample"})");
    const auto angle = last()["facets"][0]["facets"][0];
    EXPECT_EQ(angle["name"], "angle");
    EXPECT_EQ(angle["unit"], "deg");
    EXPECT_EQ(angle["has_value"], true);
    EXPECT_EQ(last()["facets"][1]["facets"][3]["moves"], true);
    say(R"({"id": 3, "do": "facets", "machine": "simple"})");
    EXPECT_EQ(last()["code"], "no_machine");
}

TEST_F(Session, gets_changed_values_only) {
    rig.machine.write("shaft.angle", 12.5, 77);
    say(R"({"id": 5, "do": "watch", "names": ["sample.shaft.angle", "sample.loom.lamp"], "rate_hz": 20})");
    ASSERT_EQ(last()["ok"], true) << last();
    EXPECT_EQ(last()["kinds"][0], "real");
    EXPECT_EQ(last()["kinds"][1], "boolean");
    rig.tick(2);
    ASSERT_THAT(client.frames, SizeIs(2));
    const std::string& first = client.frames[0];
    EXPECT_EQ(at<std::uint32_t>(first, 0), frame_magic);
    EXPECT_EQ(at<std::uint32_t>(first, 4), 5u);
    EXPECT_EQ(at<std::uint32_t>(first, 8), 1u);
    EXPECT_EQ(at<std::uint16_t>(first, 32), 2u);
    EXPECT_EQ(at<std::uint16_t>(first, 34), 0u) << "the first name";
    EXPECT_EQ(at<std::uint8_t>(first, 36), 0u) << "no flags";
    EXPECT_EQ(at<std::uint8_t>(first, 37), 1u) << "real";
    EXPECT_EQ(at<std::int64_t>(first, 38), 77);
    EXPECT_EQ(at<double>(first, 46), 12.5);
    EXPECT_EQ(at<std::uint16_t>(first, 54), 1u);
    EXPECT_EQ(at<std::uint8_t>(first, 56), frame_never_written);
    EXPECT_EQ(first.size(), 54u + 2 + 1 + 1 + 8 + 1);
    EXPECT_EQ(client.frames[1].size(), frame_head_bytes) << "nothing changed";
    EXPECT_EQ(at<std::uint32_t>(client.frames[1], 8), 2u);
    rig.machine.hold("shaft.angle", true);
    rig.tick();
    EXPECT_EQ(at<std::uint8_t>(client.frames[2], 36), frame_busy) << "never torn";
}

TEST_F(Session, that_reads_slowly_loses_frames_that_are_counted_and_no_value) {
    say(R"({"id": 5, "do": "watch", "names": ["sample.shaft.angle"], "rate_hz": 20})");
    rig.tick();
    client.reads = false;
    rig.machine.write("shaft.angle", 1.0);
    rig.tick(3);
    client.reads = true;
    rig.tick();
    ASSERT_THAT(client.frames, SizeIs(2));
    EXPECT_EQ(at<std::uint32_t>(client.frames[1], 8), 5u) << "sequence";
    EXPECT_EQ(at<std::uint32_t>(client.frames[1], 12), 3u) << "lost";
    EXPECT_EQ(at<double>(client.frames[1], 46), 1.0) << "what was lost comes again";
    EXPECT_EQ(rig.hub.counters().frames_lost, 3u);
}

TEST_F(Session, sees_how_old_a_look_is) {
    rig.machine.set_now("shaft.angle", 1000);
    say(R"({"id": 5, "do": "watch", "names": ["sample.shaft.angle"], "rate_hz": 20})");
    rig.tick();
    EXPECT_EQ(at<std::int64_t>(client.frames[0], 16), 1000);
    const auto age = at<std::int64_t>(client.frames[0], 24);
    std::this_thread::sleep_for(std::chrono::milliseconds{20});
    rig.tick();
    EXPECT_GE(at<std::int64_t>(client.frames[1], 24), age + 20'000'000) << "the machine stands still";
}

TEST_F(Session, sees_at_once_that_a_machine_stood_still_before) {
    rig.machine.set_now("shaft.angle", monotonic_ns() - 20'000'000'000);
    rig.tick();
    say(R"({"id": 5, "do": "watch", "names": ["sample.shaft.angle"], "rate_hz": 20})");
    rig.tick();
    EXPECT_GE(at<std::int64_t>(client.frames[0], 24), 20'000'000'000);
    rig.machine.set_now("shaft.angle", monotonic_ns());
    rig.tick();
    EXPECT_LT(at<std::int64_t>(client.frames[1], 24), 1'000'000'000) << "it advances again";
}

TEST_F(Session, watches_within_bounds) {
    for (std::size_t i = 1; i <= bounds.watches; ++i)
        say("{\"id\": " + std::to_string(i) +
            R"(, "do": "watch", "names": ["sample.shaft.angle"], "rate_hz": 1})");
    EXPECT_EQ(last()["ok"], true);
    say(R"({"id": 99, "do": "watch", "names": ["sample.shaft.angle"]})");
    EXPECT_EQ(last()["code"], "not_now");
    say(R"({"id": 3, "do": "machines"})");
    EXPECT_THAT(last()["error"].get<std::string>(), HasSubstr("still in use"));
    say(R"({"id": 99, "do": "unwatch", "of": 3})");
    EXPECT_EQ(last()["ok"], true);
    say(R"({"id": 100, "do": "watch", "names": ["sample.shaft.angle", "sample.shaft.anlge"]})");
    EXPECT_EQ(last()["code"], "unknown");
    say(R"({"id": 100, "do": "watch", "names": ["sample.shaft.angle", "sample.shaft.angle"]})");
    EXPECT_EQ(last()["code"], "bad_request") << "twice";
    say(R"({"id": 100, "do": "watch", "names": ["sample.shaft.angle"], "rate_hz": 21})");
    EXPECT_EQ(last()["code"], "bad_value");
    rig.tick(20);
    EXPECT_THAT(client.frames, SizeIs(bounds.watches - 1)) << "once a second each";
}

TEST_F(Session, names_a_value_once_in_a_watch) {
    say(R"({"id": 1, "do": "watch", "names": ["sample.shaft.angle", "sample.shaft.angle"]})");
    EXPECT_EQ(last()["code"], "bad_request");
    EXPECT_THAT(last()["error"].get<std::string>(), HasSubstr("twice"));
}

TEST_F(Session, keeps_its_values_when_one_of_65536_watchers_leaves) {
    Station& station = *rig.hub.find("sample");
    const std::uint32_t angle = station.with_values().front();
    const std::vector<std::uint32_t> many(65'536, angle);
    station.want(many);
    station.drop(std::span{many}.first(1), station.life());
    rig.machine.write("shaft.angle", 3.5, 99);
    station.look(monotonic_ns());
    EXPECT_EQ(station.reading(angle).stamp_ns, 99);
}

TEST_F(Session, hears_of_a_machine_that_ends) {
    say(R"({"id": 5, "do": "watch", "names": ["sample.shaft.angle"], "rate_hz": 20})");
    rig.machine.end();
    std::filesystem::remove(rig.machine.socket());
    rig.look();
    ASSERT_THAT(client.texts, SizeIs(3));
    EXPECT_EQ(client.texts[1]["id"], 5);
    EXPECT_EQ(client.texts[1]["packet"]["final"], true);
    EXPECT_EQ(client.texts[2]["packet"]["machine"]["answers"], false);
    rig.tick();
    EXPECT_THAT(client.frames, IsEmpty());
    say(R"({"id": 6, "do": "machines"})");
    EXPECT_THAT(last()["machines"], IsEmpty());
}

TEST_F(Session, asks_a_machine_under_its_users_name) {
    say(R"({"id": 8, "do": "request", "machine": "sample", "line": "get shaft.angle"})");
    EXPECT_THAT(rig.line.sent, testing::ElementsAre("4294967295 as mary engineer network"))
        << "nothing before it is accepted";
    accept();
    EXPECT_EQ(rig.line.sent.back(), "8 get shaft.angle");
    rig.line.receive("{\"id\": 8, \"ok\": true, \"values\": []}\n");
    EXPECT_EQ(last(), nlohmann::json::parse(R"({"id": 8, "ok": true, "values": []})"));
    for (const char* own : {"map", "as john engineer panel"}) {
        say(std::string{R"({"id": 9, "do": "request", "machine": "sample", "line": ")"} + own + "\"}");
        EXPECT_EQ(last()["code"], "unsupported") << own;
    }
    say(R"({"id": 9, "do": "request", "machine": "sample", "line": "get )" + std::string(5000, 'x') + "\"}");
    EXPECT_EQ(last()["code"], "bad_request");
    EXPECT_THAT(rig.line.sent, SizeIs(2));
}

TEST_F(Session, sends_nothing_when_the_machine_refuses_its_user) {
    say(R"({"id": 8, "do": "request", "machine": "sample", "line": "set shaft.gains.p 1"})");
    rig.line.receive(R"({"id": 4294967295, "ok": false, "code": "denied", "error": "no"})");
    EXPECT_EQ(last()["id"], 8);
    EXPECT_EQ(last()["code"], "denied");
    EXPECT_THAT(rig.line.sent, SizeIs(1));
    say(R"({"id": 9, "do": "request", "machine": "sample", "line": "get shaft.angle"})");
    EXPECT_THAT(rig.line.sent.back(), HasSubstr(" as mary")) << "again from the beginning";
}

TEST_F(Session, gets_later_packets_under_its_id_until_the_last) {
    say(R"({"id": 8, "do": "request", "machine": "sample", "line": "send shaft.stop 90"})");
    accept();
    rig.line.receive(R"({"id": 8, "ok": true, "state": "sent"})");
    rig.line.receive(R"({"id": 8, "command": "shaft.stop", "state": "executing"})");
    EXPECT_EQ(last()["packet"]["state"], "executing");
    rig.line.receive("");
    EXPECT_EQ(last()["packet"]["final"], true);
    EXPECT_THAT(last()["packet"]["error"].get<std::string>(), HasSubstr("has ended"));
    say(R"({"id": 8, "do": "request", "machine": "sample", "line": "get shaft.angle"})");
    EXPECT_EQ(client.texts.size(), 3u) << "the id is free again";
}

TEST_F(Session, closes_a_connection_that_nobody_uses) {
    say(R"({"id": 8, "do": "request", "machine": "sample", "line": "subscribe shaft.beat_up"})");
    accept();
    rig.line.receive(R"({"id": 8, "ok": true})");
    peer->check(rig.now + 2 * bounds.relay_idle);
    EXPECT_TRUE(rig.line.open) << "a subscription uses it";
    say(R"({"id": 9, "do": "request", "machine": "sample", "line": "unsubscribe shaft.beat_up"})");
    rig.line.receive(R"({"id": 9, "ok": true})");
    peer->check(Clock::now() + bounds.relay_idle / 2);
    EXPECT_TRUE(rig.line.open);
    peer->check(Clock::now() + 2 * bounds.relay_idle);
    EXPECT_FALSE(rig.line.open);
}

TEST_F(Session, runs_the_browsers_commands) {
    rig.machine.write("shaft.angle", 12.5);
    say(R"({"id": 4, "do": "run", "words": ["get", "shaft.angle"]})");
    EXPECT_EQ(last()["ok"], true) << last();
    rig.tick();
    EXPECT_EQ(client.texts[1]["out"], "shaft.angle = 12.5 deg\n");
    EXPECT_EQ(last()["exit"], 0);
    say(R"({"id": 4, "do": "run", "words": ["get", "shaft.angel"]})");
    rig.tick();
    EXPECT_THAT(client.texts[client.texts.size() - 2]["err"].get<std::string>(), HasSubstr("did you mean"));
    EXPECT_EQ(last()["exit"], 2);
    say(R"({"id": 4, "do": "run", "words": ["get", "shaft.angle", "--socket", "/etc/passwd"]})");
    rig.tick();
    EXPECT_EQ(last()["exit"], 2);
    say(R"({"id": 5, "do": "end", "of": 4})");
    EXPECT_EQ(last()["code"], "unknown");
}

TEST(Runs, that_change_something_are_logged) {
    const test::Folder folder;
    Rig rig{Access{LoggedIn{"mary", Role::engineer}}, folder / "log"};
    ASSERT_THAT(rig.hub.audit().open([](const Asked&) { return std::string{}; }), IsEmpty());
    Client client;
    const auto peer = rig.join(client);
    rig.machine.write("shaft.gains.p", 1.5);
    for (const char* words : {R"(["get", "shaft.angle"])", R"(["set", "shaft.gains.p", "2"])"}) {
        peer->receive(std::string{R"({"id": 1, "do": "run", "words": )"} + words + "}", rig.now);
        rig.tick();
        EXPECT_EQ(client.texts.back()["exit"], 0) << client.texts.back();
    }
    EXPECT_THAT(rig.machine.requests(), testing::Contains("as mary engineer network"))
        << "under the user's name";
    const std::string log = test::contents_of(folder / "log");
    EXPECT_THAT(log, HasSubstr(R"("line": "set shaft.gains.p 2", "before": {"shaft.gains.p": 1.5}})"));
    EXPECT_THAT(log, HasSubstr("\"outcome\": \"done\""));
    EXPECT_THAT(log, testing::Not(HasSubstr("get shaft")));
    for (const char* word : {"set", "send", "execute", "behaviour", "force", "start", "whatever"})
        EXPECT_FALSE(only_looks(word));
}

TEST(Requests, are_logged_with_values_and_outcome) {
    const test::Folder folder;
    Rig rig{Access{LoggedIn{"mary", Role::engineer}}, folder / "log"};
    ASSERT_THAT(rig.hub.audit().open([](const Asked&) { return std::string{}; }), IsEmpty());
    Client client;
    auto peer = rig.join(client);
    rig.machine.write("shaft.gains.p", 1.5);
    const auto request = [&](int id, const std::string& line) {
        peer->receive("{\"id\": " + std::to_string(id) +
                          R"(, "do": "request", "machine": "sample", "line": ")" + line + "\"}",
                      rig.now);
    };
    request(1, "set shaft.gains.p 2");
    rig.line.receive(R"({"id": 4294967295, "ok": true})");
    EXPECT_THAT(test::contents_of(folder / "log"),
                HasSubstr(R"("line": "set shaft.gains.p 2", "before": {"shaft.gains.p": 1.5}})"))
        << "before the answer";
    rig.machine.write("shaft.gains.p", 2.0);
    rig.line.receive(R"({"id": 1, "ok": true, "set": 1})");
    EXPECT_THAT(test::contents_of(folder / "log"),
                HasSubstr(R"("outcome": "done", "after": {"shaft.gains.p": 2}})"));
    request(2, "set shaft.gains.p 3");
    rig.line.receive(R"({"id": 2, "ok": false, "code": "bad_value", "error": "too much"})");
    EXPECT_THAT(test::contents_of(folder / "log"),
                HasSubstr(R"("outcome": "refused: too much", "after": {"shaft.gains.p": 2}})"));
    request(3, "send shaft.stop 90");
    rig.line.receive(R"({"id": 3, "ok": true, "state": "sent"})");
    rig.line.receive(R"({"id": 3, "command": "shaft.stop", "state": "done", "final": true})");
    request(4, "get shaft.angle");
    request(5, "force shaft.angle 1");
    peer.reset();
    const std::string log = test::contents_of(folder / "log");
    EXPECT_THAT(log, HasSubstr("unknown: the client left before the answer"));
    EXPECT_THAT(log, testing::Not(HasSubstr("get shaft.angle")));
    EXPECT_EQ(std::ranges::count(log, '\n'), 8) << log;
}

TEST(Requests, fill_the_log_neither_by_observers_nor_by_length) {
    const test::Folder folder;
    Rig rig{Access{LoggedIn{"mary", Role::engineer}}, folder / "log"};
    ASSERT_THAT(rig.hub.audit().open([](const Asked&) { return std::string{}; }), IsEmpty());
    Client client;
    const auto eve = rig.join(client, LoggedIn{"eve", Role::observer});
    eve->receive(R"({"id": 1, "do": "request", "machine": "sample", "line": "set shaft.gains.p 2"})",
                 rig.now);
    eve->receive(R"({"id": 2, "do": "run", "words": ["set", "shaft.gains.p", "2"]})", rig.now);
    EXPECT_THAT(test::contents_of(folder / "log"), IsEmpty()) << "the machine refuses it";
    Client other;
    const auto mary = rig.join(other);
    mary->receive(R"({"id": 1, "do": "run", "words": ["set", ")" + std::string(60'000, 'x') + R"("]})",
                  rig.now);
    const std::string log = test::contents_of(folder / "log");
    EXPECT_THAT(log, HasSubstr(" .. cut, it has 60004 bytes"));
    EXPECT_LT(log.size(), 2000u);
}

TEST(Requests, that_cannot_be_logged_are_not_sent) {
    Rig rig{Access{LoggedIn{"mary", Role::engineer}}, "/nowhere/log"};
    Client client;
    const auto peer = rig.join(client);
    peer->receive(R"({"id": 1, "do": "request", "machine": "sample", "line": "set shaft.gains.p 2"})",
                  rig.now);
    EXPECT_EQ(client.texts.back()["code"], "not_now");
    peer->receive(R"({"id": 1, "do": "request", "machine": "sample", "line": "get shaft.gains.p"})", rig.now);
    rig.line.receive(R"({"id": 4294967295, "ok": true})");
    EXPECT_EQ(rig.line.sent.back(), "1 get shaft.gains.p");
}

TEST(Login, is_needed_first) {
    const test::Folder folder;
    Users users;
    User mary{"mary", Role::machine_operator, Cost{2, 1, 1}, std::string(16, 's'), {}};
    mary.hash = scrypt("a long password", mary.salt, mary.cost);
    users.put(mary);
    const std::string file = folder / "users";
    ASSERT_THAT(users.write(file), IsEmpty());
    Rig rig{Access{file, users}};
    Client client, other;
    const auto peer = rig.join(client, std::nullopt);
    const auto say = [&](const std::shared_ptr<Peer>& to, std::string_view text) {
        to->receive(text, rig.now);
    };
    say(peer, R"({"id": 1, "do": "machines"})");
    EXPECT_EQ(client.texts.back()["code"], "denied");
    say(peer, R"({"id": 2, "do": "login", "user": "mary", "password": "a wrong password"})");
    say(peer, R"({"id": 3, "do": "login", "user": "mary", "password": "a long password"})");
    EXPECT_EQ(client.texts.back()["code"], "not_now") << "one after the other";
    rig.checks.back()();
    EXPECT_EQ(client.texts.back()["id"], 2);
    EXPECT_EQ(client.texts.back()["code"], "denied");
    say(peer, R"({"id": 3, "do": "login", "user": "mary", "password": "a long password"})");
    rig.checks.back()();
    EXPECT_EQ(client.texts.back()["role"], "operator");
    const std::string session = client.texts.back()["session"];
    Client hasty;
    const auto twofold = rig.join(hasty, std::nullopt);
    say(twofold, R"({"id": 1, "do": "login", "user": "mary", "password": "a long password"})");
    say(twofold, R"({"id": 2, "do": "login", "session": ")" + session + "\"}");
    EXPECT_EQ(hasty.texts.back()["code"], "not_now") << "it would be two users at once";
    const auto second = rig.join(other, std::nullopt);
    say(second, R"({"id": 1, "do": "login", "session": ")" + session + "\"}");
    EXPECT_EQ(other.texts.back()["user"], "mary");
    say(second, R"({"id": 2, "do": "logout"})");
    EXPECT_EQ(other.ended, "logged out");
    peer->check(Clock::now());
    EXPECT_THAT(client.ended, HasSubstr("the session is over")) << "it was one session";
    Client idle;
    const auto third = rig.join(idle, std::nullopt);
    third->check(rig.now + bounds.unknown / 2);
    EXPECT_THAT(idle.ended, IsEmpty());
    third->check(rig.now + 2 * bounds.unknown);
    EXPECT_THAT(idle.ended, HasSubstr("nobody logged in"));
}

} // namespace
} // namespace tappet::network
