// SPDX-License-Identifier: Apache-2.0
// bench-expect: runs a command, shows its output, and checks its exit code and that the output matches every
// given regular expression. CTest's own PASS_REGULAR_EXPRESSION asks for any one of them and forgets the exit
// code.

#include <array>
#include <cstdio>
#include <cstdlib>
#include <regex>
#include <string>
#include <vector>

#include <sys/wait.h>
#include <unistd.h>

namespace {

struct Result {
    int exit_code = -1;
    std::string output;
};

Result run(std::vector<char*> words) {
    words.push_back(nullptr);
    int ends[2];
    if (::pipe(ends) != 0) {
        return {};
    }
    const pid_t pid = ::fork();
    if (pid == 0) {
        ::dup2(ends[1], STDOUT_FILENO);
        ::dup2(ends[1], STDERR_FILENO);
        ::close(ends[0]);
        ::execv(words[0], words.data());
        ::_exit(127);
    }
    ::close(ends[1]);
    Result result;
    std::array<char, 4096> piece{};
    for (ssize_t count = 0; (count = ::read(ends[0], piece.data(), piece.size())) > 0;) {
        result.output.append(piece.data(), static_cast<std::size_t>(count));
        std::fwrite(piece.data(), 1, static_cast<std::size_t>(count), stdout);
        std::fflush(stdout);
    }
    ::close(ends[0]);
    int status = 0;
    ::waitpid(pid, &status, 0);
    result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return result;
}

} // namespace

int main(int count, char** arguments) {
    int wanted = 0;
    std::vector<std::string> expectations;
    std::vector<char*> command;
    for (int i = 1; i < count; ++i) {
        const std::string option = arguments[i];
        if (option == "--") {
            command.assign(arguments + i + 1, arguments + count);
            break;
        }
        if (i + 1 < count && option == "--exit") {
            wanted = std::atoi(arguments[++i]);
        } else if (i + 1 < count && option == "--expect") {
            expectations.emplace_back(arguments[++i]);
        } else {
            std::fprintf(stderr, "usage: bench-expect [--exit CODE] [--expect REGEX]... -- COMMAND...\n");
            return 2;
        }
    }
    if (command.empty()) {
        std::fprintf(stderr, "bench-expect: no command; give one after --\n");
        return 2;
    }
    const Result result = run(command);
    int failures = 0;
    if (result.exit_code != wanted) {
        std::printf("FAILED: exit code %d, expected %d\n", result.exit_code, wanted);
        ++failures;
    }
    for (const std::string& expectation : expectations) {
        if (!std::regex_search(result.output, std::regex(expectation))) {
            std::printf("FAILED: nothing in the output matches '%s'\n", expectation.c_str());
            ++failures;
        }
    }
    return failures == 0 ? 0 : 1;
}
