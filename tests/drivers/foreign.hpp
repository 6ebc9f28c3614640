// Foreign programs as peers of a test: cansend, gpioset, a Modbus device in Python.
#pragma once

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <spawn.h>
#include <sstream>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <utility>
#include <vector>

namespace tappet {

/// A running program; its output goes to a file, and it ends with the object.
class Foreign {
public:
    /// `into`: its output goes there instead; the reader of it fills file().
    explicit Foreign(const std::string& command, int into = -1)
        : output_{std::string{std::getenv("TMPDIR") != nullptr ? std::getenv("TMPDIR") : "/tmp"} +
                  "/foreign." + std::to_string(::getpid()) + "." + std::to_string(next_++)} {
        std::istringstream in{command};
        std::vector<std::string> words{std::istream_iterator<std::string>{in}, {}};
        std::vector<char*> arguments;
        for (std::string& word : words) arguments.push_back(word.data());
        arguments.push_back(nullptr);
        posix_spawn_file_actions_t files;
        ::posix_spawn_file_actions_init(&files);
        if (into >= 0)
            ::posix_spawn_file_actions_adddup2(&files, into, 1);
        else
            ::posix_spawn_file_actions_addopen(&files, 1, output_.c_str(), O_CREAT | O_TRUNC | O_WRONLY,
                                               0600);
        ::posix_spawn_file_actions_adddup2(&files, 1, 2);
        if (::posix_spawnp(&process_, arguments[0], &files, nullptr, arguments.data(), environ) != 0)
            process_ = -1;
        ::posix_spawn_file_actions_destroy(&files);
    }
    Foreign(const Foreign&) = delete;
    Foreign& operator=(const Foreign&) = delete;
    ~Foreign() {
        if (process_ > 0) ::kill(process_, SIGTERM);
        wait();
        ::unlink(output_.c_str());
    }
    /// Its exit code; -1 when it could not be started or was killed.
    int wait() {
        if (process_ <= 0) return code_;
        int status = 0;
        ::waitpid(std::exchange(process_, -1), &status, 0);
        code_ = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
        return code_;
    }
    [[nodiscard]] const std::string& file() const { return output_; }
    [[nodiscard]] std::string output() const {
        std::ifstream file{output_};
        return {std::istreambuf_iterator<char>{file}, {}};
    }
    /// Waits until it has written `text`; false after ten seconds.
    [[nodiscard]] bool says(const std::string& text) const {
        for (int i = 0; i < 1000; ++i) {
            if (output().find(text) != std::string::npos) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds{10});
        }
        return false;
    }
    [[nodiscard]] bool started() const { return process_ > 0; }
    [[nodiscard]] pid_t number() const { return process_; }
    void signal(int number) const {
        if (process_ > 0) ::kill(process_, number);
    }
    /// False once it has ended, even before wait().
    [[nodiscard]] bool runs() const {
        siginfo_t ended{};
        return process_ > 0 &&
               ::waitid(P_PID, static_cast<id_t>(process_), &ended, WEXITED | WNOHANG | WNOWAIT) == 0 &&
               ended.si_pid == 0;
    }

private:
    static inline int next_ = 0;
    std::string output_;
    pid_t process_ = -1;
    int code_ = -1;
};

inline int run_foreign(const std::string& command) { return Foreign{command}.wait(); }

} // namespace tappet
