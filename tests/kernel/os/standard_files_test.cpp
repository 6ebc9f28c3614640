// A program started without standard files, like a service, never prints into a file that it opens.
#include "tests/toolchain/program.hpp"

#include <gtest/gtest.h>

namespace tappet::os {
namespace {

/// Runs without the standard files in `closed`, one bit each. The exit code is the number of the opened file.
Ended run_without(unsigned closed) {
    std::string command = "exec " TAPPET_STANDARD_FILES_PROBE;
    for (unsigned file = 0; file < 3; ++file)
        if ((closed >> file & 1u) != 0) command += " " + std::to_string(file) + ">&-";
    return run_line(command);
}

constexpr unsigned out = 1u << 1;

TEST(StandardFiles, are_reserved_when_they_were_not_given) {
    for (unsigned closed = 0; closed < 8; ++closed) {
        const int opened = run_without(closed).exit_code;
        EXPECT_GE(opened, 3) << closed;
        EXPECT_LT(opened, 126) << "it was not run";
    }
}

TEST(StandardFiles, are_unchanged_when_they_were_given) {
    for (unsigned closed = 0; closed < 8; ++closed)
        EXPECT_EQ(run_without(closed).text, (closed & out) != 0 ? "" : "printed\n") << closed;
}

} // namespace
} // namespace tappet::os
