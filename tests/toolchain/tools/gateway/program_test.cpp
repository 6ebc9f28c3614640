// tappet-gateway with a real machine in real time, and a foreign client in Python (peer.py).
#include "tests/toolchain/folder.hpp"
#include "tests/toolchain/program.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <csignal>
#include <functional>
#include <sstream>
#include <thread>

#include <fcntl.h>
#include <unistd.h>

namespace tappet {
namespace {

using nlohmann::json;
using testing::Contains;
using testing::HasSubstr;
using namespace std::chrono_literals;

/// Waits until it holds; returns whether it did.
bool holds_within(std::chrono::milliseconds limit, const std::function<bool()>& what) {
    for (const auto end = std::chrono::steady_clock::now() + limit; std::chrono::steady_clock::now() < end;) {
        if (what()) return true;
        std::this_thread::sleep_for(10ms);
    }
    return what();
}

/// A program that runs beside the test; its output goes to a file. Killed at the end.
class Program {
public:
    Program(std::vector<std::string> words, std::filesystem::path output) : output_{std::move(output)} {
        child_ = ::fork();
        if (child_ != 0) return;
        std::vector<char*> raw;
        for (std::string& each : words) raw.push_back(each.data());
        raw.push_back(nullptr);
        const int file = ::open(output_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        ::dup2(file, STDOUT_FILENO);
        ::dup2(file, STDERR_FILENO);
        ::execvp(raw[0], raw.data());
        ::_exit(127);
    }
    ~Program() { end(SIGKILL); }
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    int end(int signal) {
        if (child_ <= 0) return -1;
        ::kill(child_, signal);
        return wait();
    }
    int wait() {
        int status = -1;
        if (child_ > 0) ::waitpid(std::exchange(child_, -1), &status, 0);
        return status;
    }
    [[nodiscard]] std::string output() const { return test::contents_of(output_); }
    [[nodiscard]] bool said(std::string_view text, std::chrono::milliseconds limit = 10s) const {
        return holds_within(limit, [&] { return output().contains(text); });
    }
    [[nodiscard]] pid_t id() const { return child_; }

private:
    std::filesystem::path output_;
    pid_t child_ = -1;
};

/// Its lines as JSON.
std::vector<json> rows_of(const std::string& text) {
    std::vector<json> rows;
    std::istringstream lines{text};
    for (std::string line; std::getline(lines, line);)
        if (json row = json::parse(line, nullptr, false); row.is_object()) rows.push_back(std::move(row));
    return rows;
}

class Gateway : public testing::Test {
protected:
    void SetUp() override {
        if (run_line("/usr/bin/python3 -c 'import websockets'").exit_code != 0)
            GTEST_SKIP() << "python3-websockets is not installed; ci/setup does it";
        std::filesystem::create_directory(sockets);
    }
    std::unique_ptr<Program> machine() {
        auto started = std::make_unique<Program>(
            std::vector<std::string>{TAPPET_MACHINE, "--real", "--pieces", "100000", "--for", "300",
                                     "--quiet", "--browse", sockets},
            folder / "machine");
        EXPECT_TRUE(holds_within(20s, [&] {
            return std::filesystem::exists(sockets + "/cut-to-length.socket");
        })) << started->output();
        return started;
    }
    std::unique_ptr<Program> gateway(std::vector<std::string> options) {
        std::vector<std::string> words{TAPPET_GATEWAY,
                                       "--directory",
                                       sockets,
                                       "--log",
                                       log,
                                       "--listen",
                                       "127.0.0.1:" + (port.empty() ? "0" : port)};
        words.insert(words.end(), options.begin(), options.end());
        auto started =
            std::make_unique<Program>(words, folder / ("gateway" + std::to_string(++started_gateways)));
        EXPECT_TRUE(started->said("machines of")) << started->output();
        const std::string text = started->output();
        const std::size_t at = text.find("127.0.0.1:");
        port = at == std::string::npos ? "0" : text.substr(at + 10, text.find(',', at) - at - 10);
        return started;
    }
    /// Runs a scenario of the peer to its end.
    std::vector<json> peer(const std::string& scenario, const std::string& words = {}) {
        const Ended ended = run_line("/usr/bin/python3 -W ignore " TAPPET_PEER " " + scenario + " " +
                                     address() + " " + words);
        EXPECT_EQ(ended.exit_code, 0) << ended.text;
        std::vector<json> rows = rows_of(ended.text);
        if (rows.empty()) rows.emplace_back(); // so that the test goes on to say more
        return rows;
    }
    std::unique_ptr<Program> peer_beside(const std::string& scenario, const std::string& output) {
        return std::make_unique<Program>(std::vector<std::string>{"/usr/bin/python3", "-W", "ignore",
                                                                  TAPPET_PEER, scenario, address(),
                                                                  "cut-to-length"},
                                         folder / output);
    }
    [[nodiscard]] std::string address() const { return scheme + "://127.0.0.1:" + port; }
    std::vector<std::string> with_users() {
        scheme = "wss";
        const std::string add = TAPPET_GATEWAY " user add mary operator --users " + users;
        EXPECT_EQ(run_line("printf 'a long password\\na long password\\n' | " + add).exit_code, 0);
        return {"--users", users, "--state", (folder / "state").string()};
    }

    test::Folder folder{};
    std::string sockets = folder / "sockets";
    std::string log = folder / "log";
    std::string users = folder / "users";
    std::string scheme = "ws";
    std::string port{};
    int started_gateways = 0; ///< each has an output of its own
};

template <class T> testing::Matcher<const json&> row(const std::string& name, const T& value) {
    return testing::ResultOf([name](const json& each) { return each.contains(name) ? each[name] : json{}; },
                             json(value));
}

TEST_F(Gateway, shows_changes_and_logs_a_machine) {
    const auto running = machine();
    const auto serving = gateway({"--loopback"});
    const auto rows = peer("walk", "cut-to-length");
    ASSERT_FALSE(rows.empty());
    EXPECT_EQ(rows[0]["machines"][0], "cut-to-length");
    EXPECT_THAT(rows, Contains(row("speed", 2.0)));
    EXPECT_THAT(rows, Contains(row("speed", 1.25)));
    for (const json& each : rows) {
        if (each.contains("set")) EXPECT_EQ(each["set"]["ok"], true) << each;
        if (each.contains("refused")) EXPECT_EQ(each["refused"]["code"], "bad_value") << each;
        if (each.contains("oldest_ms")) EXPECT_LT(each["oldest_ms"], 1000) << "the machine's look is fresh";
    }
    const std::string written = test::contents_of(log);
    EXPECT_THAT(written, HasSubstr(R"("line": "set line.speed 1.25", "before": {"line.speed": 2})"));
    EXPECT_THAT(written, HasSubstr(R"("outcome": "done", "after": {"line.speed": 1.25})"));
    EXPECT_THAT(written, HasSubstr("\"outcome\": \"refused: "));
    const Ended page = run_line("curl -s http://127.0.0.1:" + port + "/");
    EXPECT_THAT(page.text, HasSubstr("<td>cut-to-length.line.speed</td><td>1.25 m/s</td>"));
    const Ended metrics = run_line("curl -s http://127.0.0.1:" + port + "/metrics");
    EXPECT_THAT(metrics.text,
                HasSubstr("tappet_value{machine=\"cut-to-length\",name=\"line.speed\",unit=\"m/s\"} 1.25\n"));
    EXPECT_EQ(serving->end(SIGTERM), 0);
}

TEST_F(Gateway, lets_in_by_password_over_tls_1_3_only) {
    const auto running = machine();
    const auto serving = gateway(with_users());
    const auto in = peer("login", "mary 'a long password'");
    EXPECT_THAT(in, Contains(row("before", "denied")));
    EXPECT_THAT(in, Contains(row("role", "operator")));
    EXPECT_THAT(in, Contains(row("machines", 1)));
    for (int i = 0; i < 5; ++i)
        EXPECT_THAT(peer("login", "john 'a wrong password'"), Contains(row("ok", false)));
    EXPECT_THAT(peer("login", "john 'a wrong password'").back()["error"].get<std::string>(),
                HasSubstr("try again in "));
    EXPECT_THAT(peer("login", "mary 'a long password'"), Contains(row("ok", true)))
        << "another user at this address";
    const auto refused = peer("request", "mary 'a long password' cut-to-length 'set line.speed 1.5'");
    EXPECT_THAT(refused, Contains(row("code", "denied"))) << "an operator sets no property";
    const auto rows = peer("origin", "https://127.0.0.1:" + port + " https://evil.example null");
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(rows[0]["status"], 101);
    EXPECT_EQ(rows[1]["status"], 403);
    EXPECT_EQ(rows[2]["status"], 403);
    EXPECT_NE(run_line("curl -sk --tls-max 1.2 https://127.0.0.1:" + port + "/").exit_code, 0);
    EXPECT_THAT(run_line("curl -sk https://127.0.0.1:" + port + "/").text, HasSubstr("<h1>Log in</h1>"));
    const Ended form = run_line(
        "curl -ski -d user=mary --data-urlencode 'password=a long password' https://127.0.0.1:" + port +
        "/login");
    EXPECT_THAT(form.text, HasSubstr("Set-Cookie: __Host-tappet="));
    EXPECT_THAT(test::contents_of(log),
                HasSubstr("\"user\": \"john\", \"address\": \"127.0.0.1\", \"note\": \"login failed\""));
    struct stat key{};
    ASSERT_EQ(::stat((folder / "state/key.pem").c_str(), &key), 0);
    EXPECT_EQ(key.st_mode & 0777, 0600u);
}

TEST_F(Gateway, withstands_what_is_malformed_and_half_open) {
    const auto serving = gateway(with_users());
    for (const json& each : peer("malformed"))
        if (each.contains("code"))
            EXPECT_EQ(each["code"], "bad_request") << each;
        else
            EXPECT_THAT(each["closed"].get<int>(), testing::AnyOf(1008, 1009)) << each;
    const std::map<std::string, int> expected{
        {"huge header", 431}, {"huge body", 413}, {"nonsense", 400}, {"method", 405}, {"schema", 200}};
    std::size_t seen = 0;
    for (const json& each : peer("http")) {
        if (!each.contains("case")) continue;
        ++seen;
        EXPECT_EQ(each["status"], expected.at(each["case"])) << each;
        EXPECT_EQ(each["safe"], true) << each;
    }
    EXPECT_EQ(seen, expected.size());
    const auto closed = peer("half_open");
    ASSERT_EQ(closed.size(), 3u);
    for (const json& each : closed) EXPECT_LE(each["seconds"], 15) << each;
}

TEST_F(Gateway, counts_each_frame_of_slow_and_of_many_clients) {
    const auto running = machine();
    const auto serving = gateway({"--loopback"});
    const auto many = peer("many", "cut-to-length 10 3").back();
    EXPECT_EQ(many["clients"], 10);
    EXPECT_GE(many["frames"].get<int>() + many["lost"].get<int>(), 10 * 20 * 2) << many;
    const auto slow = peer("slow", "cut-to-length").back();
    EXPECT_GT(slow["lost"], 0) << slow;
    EXPECT_EQ(slow["watches"], 16) << "all went on afterwards";
}

TEST_F(Gateway, runs_the_browsers_commands_and_sends_their_files) {
    const auto running = machine();
    const auto serving = gateway({"--loopback"});
    const auto why = peer("run", "get line.speed").back();
    EXPECT_EQ(why["out"], "line.speed = 2 m/s\n") << why;
    const auto wrong = peer("run", "get line.sped").back();
    EXPECT_EQ(wrong["exit"], 2);
    EXPECT_THAT(wrong["err"].get<std::string>(), HasSubstr("did you mean"));
    const auto report = peer("run", "report start run.mcap --for 300ms").back();
    EXPECT_EQ(report["exit"], 0) << report;
    EXPECT_GT(report["files"]["run.mcap"], 1000) << report;
    EXPECT_FALSE(std::filesystem::exists("run.mcap"));
    EXPECT_EQ(peer("run", "set line.speed 1.5").back()["exit"], 0);
    EXPECT_THAT(test::contents_of(log),
                HasSubstr(R"("line": "set line.speed 1.5", "before": {"line.speed": 2})"));
}

TEST_F(Gateway, tells_within_a_second_when_the_machine_starts_again) {
    auto running = machine();
    const auto serving = gateway({"--loopback"});
    const auto watching = peer_beside("life", "life");
    ASSERT_TRUE(watching->said("ready")) << watching->output();
    const auto ended = std::chrono::steady_clock::now();
    running->end(SIGKILL);
    ASSERT_TRUE(watching->said("\"final\": true", 3s)) << watching->output();
    EXPECT_LT(std::chrono::steady_clock::now() - ended, 1500ms);
    std::filesystem::remove(sockets + "/cut-to-length.socket");
    running = machine();
    EXPECT_EQ(watching->wait(), 0) << watching->output();
    EXPECT_THAT(rows_of(watching->output()), Contains(row("again", true)));
}

TEST_F(Gateway, killed_amid_requests_leaves_the_machine_alone_and_repairs_its_log) {
    const auto running = machine();
    auto serving = gateway({"--loopback"});
    std::size_t open = 0;
    for (int round = 0; round < 8 && open == 0; ++round) {
        const auto flooding = peer_beside("flood", "flood");
        ASSERT_TRUE(flooding->said("ready")) << flooding->output();
        std::this_thread::sleep_for(200ms + round * 7ms);
        serving->end(SIGKILL);
        EXPECT_EQ(flooding->wait(), 0) << flooding->output();
        const auto told = rows_of(flooding->output()).back();
        std::map<std::uint64_t, std::string> outcomes;
        for (const json& each : rows_of(test::contents_of(log))) {
            if (each["what"] == "asked") outcomes[each["number"]] = "";
            if (each["what"] == "answered") outcomes[each["number"]] = each["outcome"];
        }
        for (const auto& [number, outcome] : outcomes) open += outcome.empty() ? 1 : 0;
        EXPECT_GT(told["done"], 0);
        const auto begun = std::chrono::steady_clock::now();
        serving = gateway({"--loopback"});
        EXPECT_LT(std::chrono::steady_clock::now() - begun, 1s) << "it serves again";
    }
    EXPECT_GT(open, 0u) << "no kill fell between question and answer";
    std::map<std::uint64_t, std::string> outcomes;
    for (const json& each : rows_of(test::contents_of(log))) {
        if (each["what"] == "asked") outcomes[each["number"]] = "";
        if (each["what"] != "answered") continue;
        outcomes[each["number"]] = each["outcome"];
        if (each["outcome"] != "done") {
            EXPECT_EQ(each["outcome"], "unknown: the gateway ended before the answer");
            EXPECT_TRUE(each["after"].contains("line.speed")) << each;
        }
    }
    for (const auto& [number, outcome] : outcomes) EXPECT_NE(outcome, "") << number;
    const auto after = peer("request", "- - cut-to-length 'get line.speed'");
    EXPECT_THAT(after, Contains(row("ok", true))) << "the machine goes on";
}

TEST(GatewayLine, is_refused_with_the_cure) {
    const auto said = [](const std::string& words) { return run_line(TAPPET_GATEWAY " " + words).text; };
    EXPECT_THAT(said("--listen 0.0.0.0:80 --loopback"), HasSubstr("listens at 127.0.0.1 or ::1 only"));
    EXPECT_THAT(said(""), HasSubstr("nobody could log in without --users"));
    EXPECT_THAT(said("--listen here --loopback"), HasSubstr("is not ADDRESS:PORT"));
    EXPECT_THAT(said("--loopback --users a"), HasSubstr("neither users nor a certificate"));
    EXPECT_THAT(said("--users /nowhere/users --key a"), HasSubstr("belong together"));
    EXPECT_THAT(said("--loopback --directory /nowhere"), HasSubstr("there is no folder '/nowhere'"));
    EXPECT_THAT(said("--loopback --procesors 1"), HasSubstr("did you mean --processors?"));
    EXPECT_THAT(said("users"), HasSubstr("word users is unknown"));
    EXPECT_THAT(said("--help"), HasSubstr("user add NAME observer|operator|engineer --users FILE"));
}

} // namespace
} // namespace tappet
