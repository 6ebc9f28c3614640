// User actions on the terminal of a weaving loom: none delays it, and every request to end it sets its brake.
#include "tests/bench/loom/loom_rig.hpp"

#include <array>
#include <pty.h>
#include <sys/ioctl.h>

namespace tappet::bench {
namespace {

constexpr auto limit = 100ms; ///< from the action to the brake and the valve

/// The firmware with a reader of its own in place of a file, and the plant.
class WatchedLoom {
public:
    enum class Reader : std::uint8_t { of_a_small_pipe, at_a_terminal };

    explicit WatchedLoom(Reader reader) : plant_{plant} {
        std::this_thread::sleep_for(100ms); // its Modbus server listens
        if (reader == Reader::at_a_terminal) {
            process_ = ::forkpty(&reading_, nullptr, nullptr, nullptr);
        } else {
            std::array<int, 2> ends{};
            EXPECT_EQ(::pipe2(ends.data(), O_CLOEXEC), 0);
            ::fcntl(ends[1], F_SETPIPE_SZ, 4096); // full after some seconds of the console
            reading_ = ends[0];
            process_ = ::fork();
            if (process_ == 0) ::dup2(ends[1], STDOUT_FILENO);
            if (process_ != 0) ::close(ends[1]);
        }
        if (process_ == 0) {
            ::execlp("carpet_loom", "carpet_loom", "--summary", Loom::summary_file, nullptr);
            ::_exit(127);
        }
    }
    ~WatchedLoom() {
        if (process_ > 0) ::kill(process_, SIGKILL);
        static_cast<void>(wait());
        close();
        ::unlink(Loom::summary_file);
    }
    WatchedLoom(const WatchedLoom&) = delete;
    WatchedLoom& operator=(const WatchedLoom&) = delete;

    /// Reads until it weaves; false when its output ends before.
    bool weaves() {
        std::string words;
        std::array<char, 512> part{};
        for (ssize_t got = 0; (got = ::read(reading_, part.data(), part.size())) > 0;) {
            words.append(part.data(), static_cast<std::size_t>(got));
            if (words.find("state=weave") != std::string::npos) return !is_safe();
        }
        return false;
    }
    void press(char key) const { EXPECT_EQ(::write(reading_, &key, 1), 1); }
    void close() {
        if (reading_ >= 0) ::close(std::exchange(reading_, -1));
    }
    [[nodiscard]] int unread() const {
        int bytes = 0;
        ::ioctl(reading_, FIONREAD, &bytes);
        return bytes;
    }
    void signal(int number) const { ::kill(process_, number); }
    [[nodiscard]] bool runs() const {
        siginfo_t ended{};
        return ::waitid(P_PID, static_cast<id_t>(process_), &ended, WEXITED | WNOHANG | WNOWAIT) == 0 &&
               ended.si_pid == 0;
    }
    /// Its exit code; -1 when a signal ended it.
    int wait() {
        if (process_ <= 0) return code_;
        int status = 0;
        ::waitpid(std::exchange(process_, -1), &status, 0);
        return code_ = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

private:
    static constexpr const char* plant = "carpet-loom-plant --period 1ms --operator-reaction 1s";
    Foreign plant_;
    int reading_ = -1;
    pid_t process_ = -1;
    int code_ = -1;
};

TEST(LoomTerminal, SIGTERM_brakes_while_the_output_pipe_is_full) {
    WatchedLoom loom{WatchedLoom::Reader::of_a_small_pipe};
    ASSERT_TRUE(loom.weaves());
    ASSERT_TRUE(soon([&] { return loom.unread() > 3600; }, 20s, 50ms)) << "no more than a line fits";
    std::this_thread::sleep_for(1s);
    EXPECT_FALSE(is_safe()) << "it weaves on";
    loom.signal(SIGTERM);
    EXPECT_TRUE(soon(is_safe, limit));
    EXPECT_EQ(loom.wait(), 0);
    EXPECT_GT(number_in(content_of(Loom::summary_file), "texts_dropped"), 0);
}

TEST(LoomTerminal, a_closed_pipe_stops_nothing_and_SIGTERM_still_brakes) {
    WatchedLoom loom{WatchedLoom::Reader::of_a_small_pipe};
    ASSERT_TRUE(loom.weaves());
    loom.close();
    std::this_thread::sleep_for(1s);
    EXPECT_TRUE(loom.runs());
    EXPECT_FALSE(is_safe()) << "it weaves on";
    loom.signal(SIGTERM);
    EXPECT_TRUE(soon(is_safe, limit));
    EXPECT_EQ(loom.wait(), 0);
}

TEST(LoomTerminal, a_hang_up_of_the_terminal_brakes) {
    WatchedLoom loom{WatchedLoom::Reader::at_a_terminal};
    ASSERT_TRUE(loom.weaves());
    loom.close();
    EXPECT_TRUE(soon(is_safe, limit));
    EXPECT_EQ(loom.wait(), 0);
}

TEST(LoomTerminal, control_Z_brakes_and_does_not_freeze_the_loom) {
    WatchedLoom loom{WatchedLoom::Reader::at_a_terminal};
    ASSERT_TRUE(loom.weaves());
    loom.press('\x1a');
    EXPECT_TRUE(soon(is_safe, limit));
    EXPECT_EQ(loom.wait(), 0);
}

TEST(LoomTerminal, control_S_delays_neither_the_loom_nor_its_stop) {
    WatchedLoom loom{WatchedLoom::Reader::at_a_terminal};
    ASSERT_TRUE(loom.weaves());
    loom.press('\x13');
    std::this_thread::sleep_for(2s);
    EXPECT_FALSE(is_safe()) << "it weaves on";
    loom.signal(SIGTERM);
    EXPECT_TRUE(soon(is_safe, limit));
    EXPECT_EQ(loom.wait(), 0);
}

} // namespace
} // namespace tappet::bench
