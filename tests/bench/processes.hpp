// A test's view of the processes that it started: their output, their files, and a browser's answers about a
// machine.
#pragma once

#include "tests/drivers/foreign.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <grp.h>

namespace tappet::bench {

using namespace std::chrono_literals;

/// Polls until the condition holds; false after `patience`.
template <class Condition> bool soon(Condition&& is_so, std::chrono::milliseconds patience = 5s,
                                     std::chrono::milliseconds every = 2ms) {
    for (const auto end = std::chrono::steady_clock::now() + patience;
         std::chrono::steady_clock::now() < end;) {
        if (is_so()) return true;
        std::this_thread::sleep_for(every);
    }
    return is_so();
}

inline std::string content_of(const std::string& path) {
    std::ifstream file{path};
    return {std::istreambuf_iterator<char>{file}, {}};
}

/// The process of the machine, a child of its guardian; 0: there is none.
inline pid_t machine_of(const Foreign& guardian) {
    const std::string number = std::to_string(guardian.number());
    return static_cast<pid_t>(
        std::strtol(content_of("/proc/" + number + "/task/" + number + "/children").c_str(), nullptr, 10));
}

/// A number in the summary of the firmware; -1 when it is missing.
inline double number_in(const std::string& json, std::string_view key) {
    const std::string wanted = "\"" + std::string{key} + "\": ";
    const std::size_t at = json.find(wanted);
    return at == std::string::npos ? -1.0 : std::strtod(json.c_str() + at + wanted.size(), nullptr);
}

struct Outcome {
    int code = -1;
    std::string text{}; ///< standard output, and errors after it
};

constexpr uid_t root = 0;

/// tappet-browse as a user types it.
class Browser {
public:
    /// For the machine of that name; without a name, for the only one.
    explicit Browser(std::string machine = {}) : machine_{std::move(machine)} {}

    [[nodiscard]] std::string socket() const { return "/run/tappet/" + machine_ + ".socket"; }
    /// Runs it to its end, as that user.
    Outcome run(std::vector<std::string> words, uid_t user = root) const {
        std::array<int, 2> ends{};
        if (::pipe2(ends.data(), O_CLOEXEC) != 0) return {};
        words.insert(words.begin(), "tappet-browse");
        if (!machine_.empty()) words.insert(words.begin() + 1, {"--socket", socket()});
        std::vector<char*> arguments;
        for (std::string& word : words) arguments.push_back(word.data());
        arguments.push_back(nullptr);
        const pid_t process = ::fork();
        if (process == 0) {
            ::dup2(ends[1], STDOUT_FILENO);
            ::dup2(ends[1], STDERR_FILENO);
            if (user != root && (::setgroups(0, nullptr) != 0 || ::setgid(user) != 0 || ::setuid(user) != 0))
                ::_exit(126);
            ::execvp(arguments[0], arguments.data());
            ::_exit(127);
        }
        ::close(ends[1]);
        Outcome outcome;
        std::array<char, 4096> piece{};
        for (ssize_t count = 0; (count = ::read(ends[0], piece.data(), piece.size())) > 0;)
            outcome.text.append(piece.data(), static_cast<std::size_t>(count));
        ::close(ends[0]);
        int status = 0;
        ::waitpid(process, &status, 0);
        outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
        return outcome;
    }
    /// A number with all of its digits; -1 when it is not a number.
    [[nodiscard]] double value_of(const std::string& name) const {
        constexpr int busy = 5; // a client that waits for its server counts as inside its cycle
        Outcome outcome = run({"get", "--json", name});
        for (int again = 0; again < 20 && outcome.code == busy; ++again)
            outcome = run({"get", "--json", name});
        EXPECT_EQ(outcome.code, 0) << outcome.text;
        return number_in(outcome.text, "value");
    }

private:
    std::string machine_;
};

} // namespace tappet::bench
