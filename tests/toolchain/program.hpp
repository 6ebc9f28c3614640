// Runs a program as a user does: its output on both streams, and its exit code.
#pragma once

#include <cstdio>
#include <string>

#include <sys/wait.h>

namespace tappet {

struct Ended {
    std::string text{};
    int exit_code = -1;
};

/// Runs a line of the shell.
inline Ended run_line(const std::string& line) {
    Ended ended;
    std::FILE* const output = popen(("{ " + line + "; } 2>&1").c_str(), "r"); // NOLINT: a test's own words
    if (output == nullptr) return ended;
    char characters[4096];
    for (std::size_t n = 0; (n = std::fread(characters, 1, sizeof characters, output)) != 0;)
        ended.text.append(characters, n);
    const int status = pclose(output);
    ended.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return ended;
}

} // namespace tappet
