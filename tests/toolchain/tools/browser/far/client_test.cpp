// The client of a gateway without a network: the messages that it sends, and its answer to any frames.
#include "tests/toolchain/folder.hpp"
#include "toolchain/tools/browser/far/client.hpp"

#include <nlohmann/json.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <deque>
#include <fstream>
#include <sstream>

#include <sys/stat.h>

namespace tappet::browser {
namespace {

using nlohmann::ordered_json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

struct Sent {
    std::vector<std::string> texts{};
    std::deque<std::string> answers{}; ///< one each time that the client asks for a frame
    bool is_secret = true;
};

class FakeWire final : public FarWire {
public:
    explicit FakeWire(Sent& sent) : sent_{sent} {}
    [[nodiscard]] bool is_secret() const override { return sent_.is_secret; }
    Result<void> send(const std::string& text) override {
        sent_.texts.push_back(text);
        return {};
    }
    Result<std::optional<std::string>> receive(std::chrono::milliseconds) override {
        if (sent_.answers.empty()) return failure(Fault::no_machine, "the connection is lost");
        std::string first = sent_.answers.front();
        sent_.answers.pop_front();
        if (first.empty()) return std::optional<std::string>{};
        return std::optional{std::move(first)};
    }

private:
    Sent& sent_;
};

struct FarClient : testing::Test {
    test::Folder folder{};
    Sent sent{};
    std::ostringstream out{}, errors{};
    StopFlag signal{0};
    int opened = 0;

    FarClient() {
        write("password", "correct horse\n");
        ::chmod((folder / "password").c_str(), 0600);
        ::setenv("TAPPET_PASSWORD_FILE", (folder / "password").c_str(), 1);
    }
    ~FarClient() override { ::unsetenv("TAPPET_PASSWORD_FILE"); }
    void write(const std::string& name, const std::string& text) { std::ofstream{folder / name} << text; }
    std::string read(const std::string& name) {
        std::ifstream file{folder / name};
        return {std::istreambuf_iterator<char>{file}, {}};
    }
    std::string path(const std::string& name) { return (folder / name).string(); }
    int run(std::vector<std::string> words) {
        words.insert(words.begin(), {"ann-s-box:8443", "--user", "ann"});
        const auto call = parse_call(words);
        EXPECT_TRUE(call && *call);
        Surroundings surroundings{out, errors};
        surroundings.signal = &signal;
        return run_far_line(**call, surroundings, [this](const FarCall&) -> Result<std::unique_ptr<FarWire>> {
            ++opened;
            return std::make_unique<FakeWire>(sent);
        });
    }
};

const std::string logged_in = R"({"id": 1, "ok": true, "role": "operator", "session": "x"})";
const std::string begun = R"({"id": 2, "ok": true})";

TEST(FarCallOf, words_is_one_when_the_first_is_an_address) {
    const auto of = [](std::vector<std::string> words) { return parse_call(words); };
    EXPECT_FALSE(*of({"get", "shaft.angle"}));
    EXPECT_FALSE(*of({"start", "activity:8443"})) << "only the first word is one";
    EXPECT_FALSE(*of({}));
    for (const char* word :
         {"list", ":8443", "mill-7:", "mill-7:x", "a/b:1", "mill 7:1", "mill-7:1234567", "[x]:1"})
        EXPECT_FALSE(*of({word})) << word;
    const auto call = *of({"--json", "mill-7:8443", "--ca", "ca.pem", "set", "--", "shaft.gain", "--user"});
    ASSERT_TRUE(call);
    EXPECT_EQ(call->address.host, "mill-7");
    EXPECT_EQ(call->address.port, "8443");
    EXPECT_EQ(call->ca, "ca.pem");
    EXPECT_THAT(call->words, ElementsAre("--json", "set", "--", "shaft.gain", "--user"));
    EXPECT_EQ((*of({"[fe80::1]:443"}))->address.host, "fe80::1");
    EXPECT_FALSE(of({"mill-7:8443", "--ca"}));
    EXPECT_TRUE(parse_address("127.0.0.1:80")->is_loopback());
    EXPECT_FALSE(parse_address("128.0.0.1:80")->is_loopback());
    EXPECT_FALSE(parse_address("127.mill.example:80")->is_loopback());
    EXPECT_TRUE(parse_address("LocalHost:80")->is_loopback());
    EXPECT_EQ(parse_address("LocalHost:80")->text, "localhost:80") << "a box is known by one name";
}

TEST_F(FarClient, logs_in_and_shows_what_the_line_prints_with_its_exit_code) {
    sent.answers = {"",
                    logged_in,
                    begun,
                    R"({"id": 2, "out": "shaft.angle 12.5 deg\n"})",
                    R"({"id": 2, "err": "tappet-browse: one did not answer\n"})",
                    R"({"id": 2, "exit": 3})"};
    EXPECT_EQ(run({"get", "shaft.angle"}), 3);
    EXPECT_EQ(out.str(), "shaft.angle 12.5 deg\n");
    EXPECT_EQ(errors.str(), "tappet-browse: one did not answer\n");
    ASSERT_EQ(sent.texts.size(), 2u);
    EXPECT_EQ(ordered_json::parse(sent.texts[0]),
              ordered_json::parse(R"({"id":1,"do":"login","user":"ann","password":"correct horse"})"));
    EXPECT_EQ(ordered_json::parse(sent.texts[1]),
              ordered_json::parse(R"({"id":2,"do":"run","words":["get","shaft.angle"],"screen":false})"));
}

TEST_F(FarClient, sends_no_password_where_others_could_read_it) {
    sent.is_secret = false;
    sent.answers = {begun, R"({"id": 2, "exit": 0})"};
    EXPECT_EQ(run({"list"}), 0);
    ASSERT_EQ(sent.texts.size(), 1u);
    EXPECT_THAT(sent.texts[0], HasSubstr("\"run\""));
}

TEST_F(FarClient, says_why_a_login_or_a_line_is_refused) {
    sent.answers = {R"({"id": 1, "ok": false, "error": "wrong name or password"})"};
    EXPECT_EQ(run({"list"}), 1);
    EXPECT_EQ(errors.str(), "tappet-browse: wrong name or password\n");
    sent.answers = {logged_in, R"({"id": 2, "ok": false, "error": "8 lines run already"})"};
    EXPECT_EQ(run({"list", "--json"}), 1);
    EXPECT_THAT(errors.str(), HasSubstr(R"({"error": "8 lines run already", "exit": 1})"));
}

TEST_F(FarClient, reports_a_wrong_line_and_prints_help_without_a_network) {
    EXPECT_EQ(run({"lits"}), 2);
    EXPECT_EQ(run({"get", "--cuont"}), 2);
    EXPECT_EQ(run({"help", "set"}), 0);
    EXPECT_EQ(run({"report", "convert", "a.mcap", "a.csv"}), 2);
    EXPECT_THAT(errors.str(), HasSubstr("is about files of this host; leave the address out"));
    EXPECT_EQ(opened, 0);
}

TEST_F(FarClient, refuses_a_password_file_that_others_may_read) {
    ::chmod((folder / "password").c_str(), 0640);
    EXPECT_EQ(run({"list"}), 2);
    EXPECT_THAT(errors.str(), HasSubstr("others may read it; chmod 600 it"));
    EXPECT_THAT(sent.texts, IsEmpty());
}

TEST_F(FarClient, sends_the_script_with_the_line) {
    write("twill.osd", "StateMachine Twill {}");
    sent.answers = {logged_in, begun, R"({"id": 2, "exit": 0})"};
    EXPECT_EQ(run({"behaviour", "load", path("twill.osd"), "weft", "--at", "180"}), 0) << errors.str();
    EXPECT_EQ(ordered_json::parse(sent.texts[1])["files"][path("twill.osd")], "StateMachine Twill {}");
    sent = {};
    sent.answers = {logged_in};
    write("long.osd", std::string(60'000, ' '));
    EXPECT_EQ(run({"behaviour", "load", path("long.osd"), "weft"}), 2);
    EXPECT_THAT(errors.str(), HasSubstr("at most 49152 go over the network"));
    sent.answers = {logged_in};
    EXPECT_EQ(run({"behaviour", "load", path("none.osd"), "weft"}), 2);
}

TEST_F(FarClient, writes_the_file_that_the_line_names) {
    sent.answers = {
        logged_in, begun,
        ordered_json{{"id", 2}, {"file", path("w.json")}, {"part", "eyJ0"}, {"last", false}}.dump(),
        ordered_json{{"id", 2}, {"file", path("w.json")}, {"part", "IjoxfQ=="}, {"last", true}}.dump(),
        R"({"id": 2, "exit": 0})"};
    EXPECT_EQ(run({"scope", "worst", "--to", path("w.json")}), 0) << errors.str();
    EXPECT_EQ(read("w.json"), R"({"t":1})");
}

TEST_F(FarClient, writes_a_recording_anew_and_keeps_what_came_before_a_cut) {
    const auto part = [&](const char* text) {
        return ordered_json{{"id", 2}, {"file", path("r.mcap")}, {"part", text}, {"last", false}}.dump();
    };
    sent.answers = {logged_in, begun, part("YWJj"), part("ZGVm")}; // then the connection is lost
    EXPECT_EQ(run({"report", "start", path("r.mcap"), "--for", "10s"}), 3);
    EXPECT_EQ(read("r.mcap"), "abcdef");
    sent.answers = {logged_in};
    EXPECT_EQ(run({"report", "start", path("r.mcap")}), 2);
    EXPECT_THAT(errors.str(), HasSubstr("is there already; name another file"));
}

TEST_F(FarClient, writes_no_file_that_the_line_does_not_name) {
    for (const std::string& name : {path("password"), std::string{"../x"}, std::string{}}) {
        sent.answers = {logged_in, begun,
                        ordered_json{{"id", 2}, {"file", name}, {"part", "YWJj"}, {"last", true}}.dump()};
        EXPECT_EQ(run({"scope", "worst", "--to", path("w.json")}), 3);
        EXPECT_THAT(errors.str(), HasSubstr("sends a file that nobody asked for"));
    }
    EXPECT_EQ(read("password"), "correct horse\n");
}

TEST_F(FarClient, passes_a_stop_on_once_and_awaits_the_end) {
    signal = SIGINT;
    write("twill.osd", "x");
    sent.is_secret = false;
    sent.answers = {begun, "", R"({"id": 2, "out": "last\n"})", R"({"id": 2, "exit": 0})"};
    EXPECT_EQ(run({"watch", "shaft.angle"}), 0);
    ASSERT_EQ(sent.texts.size(), 2u);
    EXPECT_EQ(ordered_json::parse(sent.texts[1]), ordered_json::parse(R"({"id":3,"do":"end","of":2})"));
    EXPECT_EQ(out.str(), "last\n");
}

TEST_F(FarClient, survives_any_frames) {
    for (const char* frame : {"", "[]", "{", "1", R"({"id": "two"})", R"({"id": 2, "exit": "no"})",
                              R"({"id": 2, "out": 1})", R"({"id": 2, "file": "x", "part": "%%%%"})",
                              R"({"id": 2, "file": 7})", R"({"id": -1, "exit": 0})"}) {
        sent.is_secret = false;
        sent.answers = {frame};
        EXPECT_EQ(run({"scope", "worst", "--to", path("x.json")}), 3) << frame;
    }
}

struct Known : testing::Test {
    test::Folder folder{};
    std::string file = (folder / "config/tappet/known_boxes").string();
    Address box = *parse_address("mill-7:8443");
};

TEST_F(Known, box_is_told_once_and_a_changed_one_is_refused) {
    const auto first = KnownBoxes{file}.check(box, "sha256:aa");
    ASSERT_TRUE(first) << first.error().sentence;
    EXPECT_THAT(*first,
                HasSubstr("mill-7:8443 is new here; its certificate sha256:aa is trusted from now on"));
    EXPECT_EQ(*KnownBoxes{file}.check(box, "sha256:aa"), "");
    EXPECT_THAT(*KnownBoxes{file}.check(*parse_address("mill-7:8444"), "sha256:bb"),
                HasSubstr("is new here"));
    const auto changed = KnownBoxes{file}.check(box, "sha256:bb");
    ASSERT_FALSE(changed);
    EXPECT_EQ(changed.error().fault, Fault::no_machine);
    EXPECT_THAT(changed.error().sentence,
                StartsWith("the certificate of mill-7:8443 has changed: it is sha256:bb"));
    struct stat state{};
    ASSERT_EQ(::stat(file.c_str(), &state), 0);
    EXPECT_EQ(state.st_mode & 0777, 0600u);
}

TEST_F(Known, box_is_not_trusted_when_it_cannot_be_remembered) {
    EXPECT_THAT(KnownBoxes{""}.check(box, "sha256:aa").error().sentence, HasSubstr("HOME is not set"));
    EXPECT_THAT(KnownBoxes{"/proc/none/known"}.check(box, "sha256:aa").error().sentence,
                HasSubstr("cannot be written"));
}

} // namespace
} // namespace tappet::browser
