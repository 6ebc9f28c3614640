// The prompt and the watch view as a user sees them: the program on a terminal of 80 columns and 24 rows
// (thesis 4.8).
#include "tests/toolchain/tools/browser/sample_machine.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tappet::browser {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::Not;

/// tappet-browse on a terminal of its own.
class Typed {
public:
    explicit Typed(const SampleMachine& machine) {
        winsize size{};
        size.ws_row = 24;
        size.ws_col = 80;
        process_ = ::forkpty(&terminal_, nullptr, nullptr, &size);
        if (process_ == 0) {
            ::setenv("TERM", "xterm", 1);
            ::setenv("HOME", machine.directory().c_str(), 1);
            ::execl(TAPPET_BROWSE, "tappet-browse", "--socket", machine.socket().c_str(), nullptr);
            ::_exit(127);
        }
        EXPECT_TRUE(shows("sample> ")) << seen_;
    }
    ~Typed() {
        if (process_ > 0) ::kill(process_, SIGKILL);
        if (process_ > 0) ::waitpid(process_, nullptr, 0);
        ::close(terminal_);
    }
    Typed(const Typed&) = delete;
    Typed& operator=(const Typed&) = delete;

    void type(std::string_view keys) {
        EXPECT_EQ(::write(terminal_, keys.data(), keys.size()), static_cast<ssize_t>(keys.size()));
    }
    /// Searches the output since the last successful search.
    bool shows(std::string_view text) {
        const auto end = std::chrono::steady_clock::now() + 10s;
        while (std::chrono::steady_clock::now() < end) {
            if (const std::size_t at = seen_.find(text); at != std::string::npos) {
                seen_.erase(0, at + text.size());
                return true;
            }
            pollfd look{terminal_, POLLIN, 0};
            if (::poll(&look, 1, 100) <= 0) continue;
            char characters[4096];
            const ssize_t count = ::read(terminal_, characters, sizeof characters);
            if (count <= 0) break;
            seen_.append(characters, static_cast<std::size_t>(count));
        }
        return false;
    }
    [[nodiscard]] const std::string& seen() const { return seen_; }
    /// The exit code; -1 when it does not end within 10 s.
    int code() {
        int status = 0;
        const auto end = std::chrono::steady_clock::now() + 10s;
        while (::waitpid(process_, &status, WNOHANG) == 0) {
            if (std::chrono::steady_clock::now() > end) return -1;
            std::this_thread::sleep_for(5ms);
        }
        process_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

private:
    int terminal_ = -1;
    pid_t process_ = -1;
    std::string seen_{};
};

TEST(Prompt, completes_names_with_tab_and_runs_the_line) {
    SampleMachine machine;
    machine.write("shaft.angle", 12.5);
    Typed typed{machine};
    typed.type("ge\tsha\t.a\t\n"); // get, shaft, shaft.angle
    EXPECT_TRUE(typed.shows("shaft.angle = 12.5 deg")) << typed.seen();
    typed.type("set shaft.g\tp\t2.5\n");
    EXPECT_TRUE(typed.shows("set: shaft.gains.p = 2.5")) << typed.seen();
    EXPECT_EQ(machine.requests().back(), "set shaft.gains.p 2.5");
    typed.type("quit\n");
    EXPECT_EQ(typed.code(), 0);
}

TEST(Prompt, lists_the_completions_of_a_name) {
    SampleMachine machine;
    Typed typed{machine};
    typed.type("set shaft.gains.\t");
    EXPECT_TRUE(typed.shows("shaft.gains.i\r\nshaft.gains.p")) << typed.seen();
}

TEST(Prompt, reports_an_error_and_continues) {
    SampleMachine machine;
    Typed typed{machine};
    typed.type("get shaft.angel\n");
    EXPECT_TRUE(typed.shows("did you mean \"shaft.angle\"?")) << typed.seen();
    typed.type("help send\n");
    EXPECT_TRUE(typed.shows("--follow")) << typed.seen();
    ASSERT_TRUE(typed.shows("sample> ")) << typed.seen(); // the key works only at the prompt
    typed.type("\x04");
    EXPECT_EQ(typed.code(), 0);
}

TEST(Prompt, keeps_its_history_for_the_next_session) {
    SampleMachine machine;
    {
        Typed typed{machine};
        typed.type("get loom.state\n");
        EXPECT_TRUE(typed.shows("loom.state = stopped")) << typed.seen();
        ASSERT_TRUE(typed.shows("sample> ")) << typed.seen();
        typed.type("quit\n");
        EXPECT_EQ(typed.code(), 0);
    }
    Typed typed{machine};
    typed.type("\x10\x10\n"); // ^P twice: after "quit"
    EXPECT_TRUE(typed.shows("loom.state = stopped")) << typed.seen();
}

TEST(Prompt, an_interrupt_cancels_only_the_line) {
    SampleMachine machine;
    Typed typed{machine};
    typed.type("get nonsense\x03");
    ASSERT_TRUE(typed.shows("sample> ")) << typed.seen();
    typed.type("get loom.state\n");
    EXPECT_TRUE(typed.shows("loom.state = stopped")) << typed.seen();
}

TEST(WatchView, refreshes_marks_forced_values_and_ends_with_q) {
    SampleMachine machine;
    machine.write("shaft.angle", 12.5);
    Typed typed{machine};
    typed.type("watch shaft.angle --every 20ms\n");
    ASSERT_TRUE(typed.shows("12.5")) << typed.seen();
    machine.write("shaft.angle", 33.25);
    ASSERT_TRUE(typed.shows("33.25")) << typed.seen();
    EXPECT_THAT(typed.seen(), Not(HasSubstr("FORCED")));
    machine.force("shaft.angle", true, 90.0);
    EXPECT_TRUE(typed.shows("1 FORCED")) << "in the title:\n" << typed.seen();
    EXPECT_TRUE(typed.shows("FORCED\x1b[0m")) << "in its row:\n" << typed.seen();
    typed.type("q");
    ASSERT_TRUE(typed.shows("sample> ")) << typed.seen();
    typed.type("get shaft.angle\n");
    EXPECT_TRUE(typed.shows("shaft.angle = 90 deg   FORCED")) << typed.seen();
}

TEST(WatchView, says_when_the_machine_has_ended_and_exits_with_3) {
    SampleMachine machine;
    Typed typed{machine};
    typed.type("watch shaft.angle --every 20ms\n");
    ASSERT_TRUE(typed.shows("picture 2")) << typed.seen();
    machine.end();
    EXPECT_TRUE(typed.shows("the machine has ended")) << typed.seen();
    EXPECT_EQ(typed.code(), 3);
}

} // namespace
} // namespace tappet::browser
