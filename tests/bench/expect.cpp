// SPDX-License-Identifier: Apache-2.0
// bench-expect: runs a command, shows its output, and checks its exit code, that the output matches every
// given regular expression, and that the lines of each golden file occur in it, in order, with all varying
// parts masked. CTest's own PASS_REGULAR_EXPRESSION requires only one of them and ignores the exit code.

#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <regex>
#include <sstream>
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

/// Addresses, times, numbers of processes and threads, the build.
std::string masked(const std::string& line) {
    static const std::pair<std::regex, const char*> masks[] = {
        {std::regex("\r"), ""},
        {std::regex("(0x[0-9a-f]+ )*0x[0-9a-f]+"), "0x#"},
        {std::regex("[0-9]{4}-[0-9]{2}-[0-9]{2} [0-9:]{8} UTC"), "DATE"},
        {std::regex("[0-9]+ us"), "# us"},
        {std::regex("(build|thread) [0-9a-f]+"), "$1 #"}};
    std::string text = line;
    for (const auto& [what, mask] : masks) text = std::regex_replace(text, what, mask);
    return text;
}

std::vector<std::string> lines_of(std::istream&& in) {
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line);) lines.push_back(masked(line));
    return lines;
}

bool has_golden(const std::string& output, const std::string& file) {
    const auto golden = lines_of(std::ifstream{file}), lines = lines_of(std::istringstream{output});
    std::size_t most = 0, at = 0;
    for (std::size_t i = 0; i < lines.size() && most < golden.size(); ++i) {
        std::size_t n = 0;
        while (n < golden.size() && i + n < lines.size() && lines[i + n] == golden[n]) ++n;
        if (n > most) most = n, at = i;
    }
    if (!golden.empty() && most == golden.size()) return true;
    std::printf("FAILED: the output is not as in %s from its line %zu on; masked, it continues:\n",
                file.c_str(), most + 1);
    for (std::size_t i = at + most; i < lines.size() && i < at + golden.size() + 2; ++i)
        std::printf("%s\n", lines[i].c_str());
    return false;
}

} // namespace

int main(int count, char** arguments) {
    int wanted = 0;
    std::vector<std::string> expectations, goldens;
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
        } else if (i + 1 < count && option == "--golden") {
            goldens.emplace_back(arguments[++i]);
        } else {
            std::fprintf(stderr,
                         "usage: bench-expect [--exit CODE] [--expect REGEX]... [--golden FILE]... -- "
                         "COMMAND...\n");
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
    for (const std::string& golden : goldens) failures += has_golden(result.output, golden) ? 0 : 1;
    return failures == 0 ? 0 : 1;
}
