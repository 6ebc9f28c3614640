// tappet-browse at the address of a real gateway, with a real machine behind it: every kind of command, files
// both ways, and a user whom the machine knows.
#include "tests/toolchain/folder.hpp"
#include "tests/toolchain/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <functional>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace tappet {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// A program beside the test, ended with it; its output goes to a file.
class Beside {
public:
    Beside(std::vector<std::string> words, const std::string& output) : child_{::fork()} {
        if (child_ != 0) return;
        std::vector<char*> raw;
        for (std::string& each : words) raw.push_back(each.data());
        raw.push_back(nullptr);
        const int file = ::open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
        ::dup2(file, STDOUT_FILENO);
        ::dup2(file, STDERR_FILENO);
        ::execv(raw[0], raw.data());
        ::_exit(127);
    }
    ~Beside() {
        ::kill(child_, SIGTERM);
        ::waitpid(child_, nullptr, 0);
    }
    Beside(const Beside&) = delete;
    Beside& operator=(const Beside&) = delete;

private:
    pid_t child_;
};

bool holds_soon(const std::function<bool()>& what) {
    for (int i = 0; i < 2000 && !what(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds{10});
    return what();
}

class BehindGateway : public testing::Test {
protected:
    void SetUp() override {
        std::filesystem::create_directory(at("sockets"));
        machine = std::make_unique<Beside>(
            std::vector<std::string>{TAPPET_MACHINE, "--real", "--for", "300", "--browse", at("sockets")},
            at("machine"));
        ASSERT_TRUE(holds_soon([this] {
            return std::filesystem::exists(at("sockets/cut-to-length.socket"));
        })) << test::contents_of(at("machine"));
    }
    void serve(std::vector<std::string> options) {
        std::vector<std::string> words{TAPPET_GATEWAY, "--directory", at("sockets"), "--log",
                                       at("log"),      "--listen",    "127.0.0.1:0"};
        words.insert(words.end(), options.begin(), options.end());
        gateway = std::make_unique<Beside>(words, at("gateway"));
        ASSERT_TRUE(holds_soon([this] { return test::contents_of(at("gateway")).contains("machines of"); }));
        const std::string told = test::contents_of(at("gateway"));
        const std::size_t from = told.find("127.0.0.1:");
        ASSERT_NE(from, std::string::npos) << told;
        address = told.substr(from, told.find(',', from) - from);
    }
    std::string at(const std::string& name) { return (folder / name).string(); }
    /// Runs tappet-browse in the test's folder, at the gateway's address.
    Ended browse(const std::string& words, const std::string& before = {}) {
        return run_line("cd " + folder.string() + " && HOME=" + folder.string() +
                        " TAPPET_PASSWORD_FILE=" + at("password") + " timeout --preserve-status " +
                        (before.empty() ? "60" : before) + " " + TAPPET_BROWSE + " " + address + " " + words);
    }

    test::Folder folder{};
    std::string address{};
    std::unique_ptr<Beside> machine{}, gateway{};
};

TEST_F(BehindGateway, every_kind_of_command_works_as_at_the_machine) {
    serve({"--loopback"});
    EXPECT_THAT(browse("").text, StartsWith("cut-to-length  on host"));
    EXPECT_THAT(browse("set line.speed 1.25").text, HasSubstr("set: line.speed = 1.25"));
    EXPECT_EQ(browse("get line.speed").text, "line.speed = 1.25 m/s\n");
    EXPECT_THAT(browse("watch line.speed --count 2 --every 10ms --json").text, HasSubstr("1.25"));
    const Ended wrong = browse("set line.speed 1000");
    EXPECT_EQ(wrong.exit_code, 1) << wrong.text;
    EXPECT_EQ(browse("get line.sped").exit_code, 2);
    EXPECT_EQ(browse("list --directory /").exit_code, 2);
    EXPECT_THAT(browse("behaviour list").text, HasSubstr("line.line_states: "));
    std::ofstream{at("m.osd")} << "StateMachine M {}";
    EXPECT_THAT(browse("behaviour load m.osd line").text, HasSubstr("no slot is reserved"));
}

TEST_F(BehindGateway, a_recording_arrives_here_and_a_signal_ends_it) {
    serve({"--loopback"});
    const Ended whole = browse("report start whole.mcap --for 300ms");
    EXPECT_EQ(whole.exit_code, 0) << whole.text;
    const Ended stopped = browse("report start stopped.mcap", "-s INT 2");
    EXPECT_EQ(stopped.exit_code, 0) << stopped.text;
    EXPECT_THAT(stopped.text, HasSubstr("written to stopped.mcap: "));
    for (const std::string name : {"whole", "stopped"}) {
        const std::string files = at(name + ".mcap") + " " + at(name + ".csv");
        EXPECT_THAT(run_line(TAPPET_BROWSE " report convert " + files).text,
                    testing::AllOf(HasSubstr("messages of "), testing::Not(HasSubstr("cut off"))));
    }
    EXPECT_EQ(browse("report start whole.mcap").exit_code, 2) << "it is there already";
}

TEST_F(BehindGateway, a_user_logs_in_by_tls_and_stands_in_the_machine_s_log) {
    std::ofstream{at("password")} << "a long password\n";
    ::chmod(at("password").c_str(), 0600);
    ASSERT_EQ(run_line("printf 'a long password\\na long password\\n' | " TAPPET_GATEWAY
                       " user add mary operator --users " +
                       at("users"))
                  .exit_code,
              0);
    serve({"--users", at("users"), "--state", at("state")});
    const Ended first = browse("--user mary get line.speed");
    EXPECT_THAT(first.text, HasSubstr(" is new here; its certificate sha256:"));
    EXPECT_THAT(first.text, testing::EndsWith("line.speed = 2 m/s\n"));
    EXPECT_EQ(browse("--user mary get line.speed").text, "line.speed = 2 m/s\n");
    EXPECT_EQ(browse("--user mary --ca state/certificate.pem get line.speed").text, "line.speed = 2 m/s\n");
    const Ended denied = browse("--user mary set line.speed 1");
    EXPECT_EQ(denied.exit_code, 1);
    EXPECT_THAT(denied.text, HasSubstr("needs the role of an engineer, you are an operator"));
    EXPECT_TRUE(holds_soon(
        [this] { return test::contents_of(at("machine")).contains("operator mary from the network: "); }));
    std::ofstream{at("password")} << "another password\n";
    EXPECT_EQ(browse("--user mary get line.speed").exit_code, 1);
}

} // namespace
} // namespace tappet
