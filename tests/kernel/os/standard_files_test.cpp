// A program that is started without standard files, as a service may be, prints into nothing that it opens.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <string>

#include <sys/wait.h>

namespace tappet::os {
namespace {

struct Ending {
    std::string output;
    int opened = -1; // the number of the file that it opened
};

/// Without the standard files in `closed`, a bit for each.
Ending run_without(unsigned closed) {
    std::string command = "exec " TAPPET_STANDARD_FILES_PROBE;
    for (unsigned file = 0; file < 3; ++file)
        if ((closed >> file & 1u) != 0) command += " " + std::to_string(file) + ">&-";
    Ending ending;
    FILE* pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) return ending;
    std::array<char, 64> part{};
    while (std::fgets(part.data(), part.size(), pipe) != nullptr) ending.output += part.data();
    const int status = pclose(pipe);
    if (WIFEXITED(status)) ending.opened = WEXITSTATUS(status);
    return ending;
}

constexpr unsigned out = 1u << 1;

TEST(StandardFiles, that_were_not_given_are_nothing_that_a_program_opens) {
    for (unsigned closed = 0; closed < 8; ++closed) {
        const Ending ending = run_without(closed);
        EXPECT_GE(ending.opened, 3) << closed;
        EXPECT_LT(ending.opened, 126) << "it was not run";
    }
}

TEST(StandardFiles, that_were_given_stay_what_they_are) {
    for (unsigned closed = 0; closed < 8; ++closed)
        EXPECT_EQ(run_without(closed).output, (closed & out) != 0 ? "" : "printed\n") << closed;
}

} // namespace
} // namespace tappet::os
