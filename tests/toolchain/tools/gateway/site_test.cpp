// HTTP requests as functions: origins, cookies, pages, metrics.
#include "tests/toolchain/program.hpp"
#include "tests/toolchain/tools/gateway/rig.hpp"
#include "toolchain/tools/gateway/encoding.hpp"
#include "toolchain/tools/gateway/site.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>

namespace tappet::network {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// A gateway with one user, behind TLS.
class Guarded : public testing::Test {
protected:
    Guarded() : rig{Access{file(), users()}}, site{rig.hub, true} {}
    std::string file() { return folder / "users"; }
    Users users() {
        Users all;
        User mary{"mary", Role::engineer, Cost{2, 1, 1}, std::string(16, 's'), {}};
        mary.hash = scrypt("a long password", mary.salt, mary.cost);
        all.put(mary);
        EXPECT_THAT(all.write(file()), IsEmpty());
        return all;
    }
    HttpReply ask(const HttpRequest& request) {
        std::optional<HttpReply> got;
        site.answer(request, [&](HttpReply reply) { got = std::move(reply); });
        for (const auto& check : std::exchange(rig.checks, {})) check();
        EXPECT_TRUE(got);
        return got.value_or(HttpReply{});
    }
    HttpReply get(std::string target, std::string cookie = {}) {
        return ask({.method = "GET",
                    .target = std::move(target),
                    .host = "mill:8443",
                    .cookie = std::move(cookie),
                    .address = "10.0.0.1"});
    }
    HttpReply post(std::string target, std::string body, std::string origin = "https://mill:8443",
                   std::string cookie = {}) {
        return ask({.method = "POST",
                    .target = std::move(target),
                    .host = "mill:8443",
                    .origin = std::move(origin),
                    .cookie = std::move(cookie),
                    .body = std::move(body),
                    .address = "10.0.0.1"});
    }
    static std::string header(const HttpReply& reply, std::string_view name) {
        for (const auto& [each, value] : reply.headers)
            if (each == name) return value;
        return {};
    }
    /// Logs in; returns the cookie as a browser sends it.
    std::string cookie() {
        const std::string set = header(post("/login", "user=mary&password=a+long+password"), "Set-Cookie");
        return set.substr(0, set.find(';'));
    }
    HttpRequest upgrade(std::string origin, std::string with = {}) {
        return {.method = "GET",
                .target = "/v1",
                .host = "mill:8443",
                .origin = std::move(origin),
                .cookie = std::move(with),
                .protocols = "other, tappet.v1"};
    }

    test::Folder folder{};
    Rig rig;
    Site site;
};

TEST_F(Guarded, shows_values_after_the_login_only) {
    EXPECT_THAT(get("/").body, HasSubstr("<form method=\"post\" action=\"/login\">"));
    EXPECT_THAT(get("/").body, Not(HasSubstr("shaft.angle")));
    EXPECT_THAT(get("/", cookie()).body, HasSubstr("<td>sample.shaft.angle</td>"));
    EXPECT_EQ(get("/elsewhere", cookie()).status, 404u);
}

TEST_F(Guarded, gives_a_cookie_that_scripts_and_other_sites_cannot_use) {
    const HttpReply in = post("/login", "user=mary&password=a+long+password");
    EXPECT_EQ(in.status, 303u);
    EXPECT_THAT(
        header(in, "Set-Cookie"),
        testing::MatchesRegex("__Host-tappet=[A-Za-z0-9_-]+; Path=/; HttpOnly; SameSite=Strict; Secure"));
    EXPECT_EQ(post("/login", "user=mary&password=wrong").status, 401u);
    EXPECT_EQ(post("/login", "user=%").status, 400u);
}

TEST_F(Guarded, ends_a_session_by_logout_and_takes_no_cookie_again) {
    const std::string session = cookie();
    EXPECT_THAT(header(post("/logout", "", "https://mill:8443", session), "Set-Cookie"),
                HasSubstr("Max-Age=0"));
    EXPECT_THAT(get("/", session).body, HasSubstr("action=\"/login\"")) << "a replayed cookie";
}

TEST_F(Guarded, takes_nothing_from_other_origins) {
    const std::string session = cookie();
    for (const char* origin : {"https://evil.example", "http://mill:8443", "https://mill",
                               "https://mill:8443.evil.example", "null"}) {
        EXPECT_EQ(post("/login", "user=mary&password=a+long+password", origin).status, 403u) << origin;
        EXPECT_EQ(post("/logout", "", origin, session).status, 403u) << origin;
        EXPECT_TRUE(std::holds_alternative<HttpReply>(site.upgrade(upgrade(origin, session)))) << origin;
        EXPECT_TRUE(std::holds_alternative<HttpReply>(site.upgrade(upgrade(origin)))) << origin;
    }
    EXPECT_EQ(post("/logout", "", "", session).status, 403u) << "a cookie without an origin";
    EXPECT_TRUE(std::holds_alternative<HttpReply>(site.upgrade(upgrade("", session))));
    const auto admitted = site.upgrade(upgrade("https://MILL:8443", session));
    ASSERT_TRUE(std::holds_alternative<Admission>(admitted));
    EXPECT_EQ(std::get<Admission>(admitted).who->user, "mary");
    const auto stranger = site.upgrade(upgrade(""));
    ASSERT_TRUE(std::holds_alternative<Admission>(stranger)) << "a program logs in by message";
    EXPECT_FALSE(std::get<Admission>(stranger).who);
    HttpRequest without = upgrade("https://mill:8443", session);
    without.protocols = "tappet.v2";
    EXPECT_EQ(std::get<HttpReply>(site.upgrade(without)).status, 400u);
}

TEST_F(Guarded, gives_metrics_to_prometheus_by_its_password) {
    EXPECT_EQ(get("/metrics").status, 401u);
    const auto scrape = [&](std::string_view password) {
        return ask({.method = "GET",
                    .target = "/metrics",
                    .host = "mill:8443",
                    .authorization = "Basic " + to_base64("mary:" + std::string{password}),
                    .address = "10.0.0.1"});
    };
    EXPECT_EQ(scrape("a wrong password").status, 401u);
    EXPECT_EQ(scrape("a long password").status, 200u);
    EXPECT_THAT(scrape("a long password").body, HasSubstr("tappet_up{machine=\"sample\"} 0\n"))
        << "it stands";
    rig.machine.set_now("shaft.angle", monotonic_ns());
    rig.hub.tick(rig.now);
    bool checked = false;
    rig.checks.emplace_back([&] { checked = true; });
    EXPECT_THAT(scrape("a long password").body, HasSubstr("tappet_up{machine=\"sample\"} 1\n"));
    EXPECT_TRUE(checked && rig.checks.empty()) << "one password check for many scrapes";
}

TEST(Loopback, trusts_no_other_name) {
    Rig rig;
    Site site{rig.hub, false};
    const auto status = [&](std::string host, std::string origin) {
        const auto answer = site.upgrade({.method = "GET",
                                          .target = "/v1",
                                          .host = std::move(host),
                                          .origin = std::move(origin),
                                          .protocols = "tappet.v1"});
        const auto* refusal = std::get_if<HttpReply>(&answer);
        return refusal == nullptr ? 101u : refusal->status;
    };
    EXPECT_EQ(status("127.0.0.1:8080", ""), 101u);
    EXPECT_EQ(status("localhost:8080", "http://localhost:8080"), 101u);
    EXPECT_EQ(status("[::1]:8080", "http://[::1]:8080"), 101u);
    EXPECT_EQ(status("evil.example:8080", "http://evil.example:8080"), 403u) << "its name leads here";
    EXPECT_EQ(status("127.0.0.1:8080", "http://evil.example"), 403u);
    HttpReply page;
    site.answer({.method = "GET", .target = "/", .host = "evil.example"},
                [&](HttpReply reply) { page = std::move(reply); });
    EXPECT_EQ(page.status, 403u);
}

TEST(Metrics, leave_out_what_is_not_known) {
    Rig rig;
    rig.machine.write("shaft.angle", 12.5);
    rig.machine.set_now("shaft.angle", monotonic_ns());
    rig.tick();
    const auto text = [&] { return metrics_text(rig.hub.stations(), rig.hub.counters(), MetricsForm::open); };
    EXPECT_THAT(text(),
                HasSubstr("tappet_value{machine=\"sample\",name=\"shaft.angle\",unit=\"deg\"} 12.5\n"));
    EXPECT_THAT(text(), Not(HasSubstr("name=\"loom.lamp\""))) << "never written";
    EXPECT_THAT(text(),
                HasSubstr("tappet_figure{machine=\"sample\",activity=\"motion\",name=\"cycles\"} 0\n"));
    EXPECT_THAT(text(), testing::EndsWith("# EOF\n"));
    rig.machine.hold("shaft.angle", true);
    EXPECT_THAT(text(), Not(HasSubstr("name=\"shaft.angle\""))) << "busy";
    EXPECT_EQ(label_text("a\"b\\c\nd\xff"), "a\\\"b\\\\c\\nd?");
}

TEST(Metrics, are_accepted_by_prometheus) {
    if (std::system("promtool --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "promtool is not installed";
    Rig rig;
    rig.machine.write("shaft.angle", 12.5);
    rig.machine.write("loom.lamp", true);
    const test::Folder folder;
    std::ofstream{folder / "metrics"}
        << metrics_text(rig.hub.stations(), rig.hub.counters(), MetricsForm::plain);
    const Ended checked = run_line("promtool check metrics < " + (folder / "metrics").string());
    EXPECT_EQ(checked.exit_code, 0) << checked.text;
    EXPECT_THAT(checked.text, IsEmpty());
}

} // namespace
} // namespace tappet::network
