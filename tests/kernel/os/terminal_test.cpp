// Output of a machine reaches its reader whole or not at all, and never blocks its writer.
#include "kernel/os/terminal.hpp"

#include "kernel/os/signals.hpp"
#include "kernel/os/thread.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <string>

#include <fcntl.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

namespace tappet::os {
namespace {

void ignore(int) noexcept {}

/// Redirects standard output to one end of something during its lifetime.
class StandardOutput {
public:
    explicit StandardOutput(int end) : kept_{::dup(STDOUT_FILENO)} {
        ::dup2(end, STDOUT_FILENO);
        ::close(end);
        on_termination(&ignore);
        never_wait();
        before_ = dropped_texts();
    }
    ~StandardOutput() {
        ::dup2(kept_, STDOUT_FILENO);
        ::close(kept_);
        never_wait();
        on_termination(nullptr);
    }
    StandardOutput(const StandardOutput&) = delete;
    StandardOutput& operator=(const StandardOutput&) = delete;

    [[nodiscard]] std::uint64_t dropped() const { return dropped_texts() - before_; }

private:
    int kept_;
    std::uint64_t before_ = 0;
};

std::string line(int number) { return "line " + std::to_string(number) + std::string(90, '.') + "\n"; }

/// The text available now.
std::string take(int from) {
    ::fcntl(from, F_SETFL, ::fcntl(from, F_GETFL) | O_NONBLOCK);
    std::string all(1 << 20, '\0');
    std::size_t length = 0;
    for (ssize_t got = 0; (got = ::read(from, all.data() + length, all.size() - length)) > 0;)
        length += static_cast<std::size_t>(got);
    all.resize(length);
    return all;
}

/// Every line is one of ours, in order, or states how many are missing.
void expect_whole_lines(const std::string& read) {
    int next = 0;
    for (std::size_t at = 0; at < read.size();) {
        const std::size_t end = read.find('\n', at);
        ASSERT_NE(end, std::string::npos) << "half a line: " << read.substr(at);
        std::string one = read.substr(at, end - at + 1);
        std::erase(one, '\r');
        if (one.starts_with("(")) {
            next += std::atoi(one.c_str() + 1);
            EXPECT_NE(one.find("dropped here"), std::string::npos) << one;
        } else {
            EXPECT_EQ(one, line(next++));
        }
        at = end + 1;
    }
}

constexpr int more_than_fits = 3000;

void write_more_than_fits() {
    for (int n = 0; n < more_than_fits; ++n) print(line(n));
}

TEST(Terminal, drops_and_counts_whole_texts_while_the_pipe_reader_is_stopped) {
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    const StandardOutput output{ends[1]};
    write_more_than_fits(); // it returned, as promised
    EXPECT_GT(output.dropped(), 1000u);
    const auto dropped = output.dropped();
    std::string all = take(ends[0]);
    print(line(more_than_fits));
    all += take(ends[0]);
    EXPECT_EQ(output.dropped(), dropped) << "there is room again";
    expect_whole_lines(all);
    EXPECT_NE(all.find("(" + std::to_string(dropped) + " texts were dropped here"), std::string::npos);
    EXPECT_TRUE(all.ends_with(line(more_than_fits)));
    ::close(ends[0]);
}

TEST(Terminal, leaves_a_shared_pipe_unchanged_for_other_users) {
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    const int shared = ::dup(ends[1]);
    const StandardOutput output{ends[1]};
    print("x");
    EXPECT_EQ(::fcntl(shared, F_GETFL) & O_NONBLOCK, 0);
    ::close(shared);
    ::close(ends[0]);
}

TEST(Terminal, survives_the_exit_of_a_reader) {
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    const StandardOutput output{ends[1]};
    print("before\n");
    ::close(ends[0]);
    print("after\n"); // no signal ends the process, and nothing waits
    EXPECT_EQ(output.dropped(), 1u);
}

TEST(Terminal, starts_without_a_reader) {
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    ::close(ends[0]);
    const StandardOutput output{ends[1]};
    print("nobody\n");
    EXPECT_EQ(output.dropped(), 1u);
}

TEST(Terminal, does_not_wait_for_a_stopped_or_closed_terminal) {
    const int master = ::posix_openpt(O_RDWR | O_NOCTTY);
    ASSERT_TRUE(master >= 0 && ::grantpt(master) == 0 && ::unlockpt(master) == 0);
    const int terminal = ::open(::ptsname(master), O_RDWR | O_NOCTTY);
    ASSERT_GE(terminal, 0);
    const int kept = ::dup(terminal);
    const StandardOutput output{terminal};
    ASSERT_EQ(::tcflow(kept, TCOOFF), 0); // the effect of Ctrl-S
    write_more_than_fits();
    EXPECT_GT(output.dropped(), 1000u);
    ASSERT_EQ(::tcflow(kept, TCOON), 0);
    expect_whole_lines(take(master) + [&] {
        print(line(more_than_fits));
        return take(master);
    }());
    ::close(kept);
    ::close(master);
    const auto before = output.dropped();
    print("gone\n");
    EXPECT_EQ(output.dropped(), before + 1);
}

TEST(Terminal, does_not_wait_for_a_file_that_it_may_not_reopen) {
    if (::geteuid() != 0) GTEST_SKIP() << "only root can become somebody who may not";
    for (const bool at_terminal : {false, true}) {
        int ends[2];
        if (at_terminal) {
            ends[0] = ::posix_openpt(O_RDWR | O_NOCTTY);
            ASSERT_TRUE(ends[0] >= 0 && ::grantpt(ends[0]) == 0 && ::unlockpt(ends[0]) == 0);
            ends[1] = ::open(::ptsname(ends[0]), O_RDWR | O_NOCTTY);
        } else {
            ASSERT_EQ(::pipe(ends), 0);
        }
        constexpr uid_t nobody = 65534;
        ASSERT_EQ(::seteuid(nobody), 0);
        {
            const StandardOutput output{ends[1]};
            print(line(0));
            EXPECT_EQ(output.dropped(), 0u) << "what is read is written";
            for (int n = 1; n < more_than_fits; ++n) print(line(n));
            EXPECT_GT(output.dropped(), 100u);
            std::string all = take(ends[0]);
            print(line(more_than_fits));
            expect_whole_lines(all + take(ends[0]));
        }
        ASSERT_EQ(::seteuid(0), 0);
        ::close(ends[0]);
    }
}

TEST(Terminal, does_not_wait_for_a_socket) {
    int ends[2];
    ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
    const StandardOutput output{ends[1]};
    write_more_than_fits();
    EXPECT_GT(output.dropped(), 100u);
    expect_whole_lines(take(ends[0]));
    ::close(ends[0]);
    const auto before = output.dropped();
    print("gone\n");
    EXPECT_EQ(output.dropped(), before + 1);
}

TEST(Terminal, appends_to_the_content_of_a_file) {
    const std::string path = testing::TempDir() + "terminal_test." + std::to_string(::getpid());
    const int file = ::open(path.c_str(), O_CREAT | O_RDWR | O_TRUNC | O_CLOEXEC, 0600);
    ASSERT_GE(file, 0);
    const int reader = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    ::unlink(path.c_str());
    ASSERT_TRUE(write_all(file, "first\n"));
    {
        const StandardOutput output{file};
        print("second\n");
        EXPECT_EQ(output.dropped(), 0u);
    }
    EXPECT_EQ(take(reader), "first\nsecond\n");
    ::close(reader);
}

TEST(Signals, are_handed_over_when_they_would_end_or_freeze_the_process) {
    static int got = 0;
    on_termination([](int number) noexcept { got = number; });
    for (const int number :
         {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGTSTP, SIGUSR1, SIGALRM, SIGXCPU, SIGRTMIN}) {
        ::raise(number);
        EXPECT_EQ(got, number);
    }
    got = 0;
    for (const int number : {SIGPIPE, SIGTTIN, SIGTTOU, SIGXFSZ}) ::raise(number);
    EXPECT_EQ(got, 0);
    on_termination(nullptr);
}

TEST(Signals, are_handled_by_the_starter_of_a_thread_only) {
    static std::atomic<int> got{0};
    got = 0;
    on_termination([](int number) noexcept { got = number; });
    static std::atomic<bool> ends{false}, looked{false};
    ends = looked = false;
    const ThreadPlan plan{.name = "busy",
                          .body =
                              [](void*) noexcept {
                                  while (!ends) looked = true;
                              },
                          .context = nullptr};
    Thread thread;
    ASSERT_TRUE(thread.start(plan));
    while (!looked) {
    }
    sigset_t term{};
    sigemptyset(&term);
    sigaddset(&term, SIGTERM);
    ASSERT_EQ(::pthread_sigmask(SIG_BLOCK, &term, nullptr), 0);
    ::kill(::getpid(), SIGTERM); // to any thread that accepts it
    looked = false;
    while (!looked) { // it continued, and by then had the signal if it accepted it
    }
    EXPECT_EQ(got, 0);
    ends = true;
    thread.join();
    ::pthread_sigmask(SIG_UNBLOCK, &term, nullptr);
    EXPECT_EQ(got, SIGTERM);
    on_termination(nullptr);
}

} // namespace
} // namespace tappet::os
