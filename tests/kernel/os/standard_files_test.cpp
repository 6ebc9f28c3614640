// A program that is started without standard files, as a service may be, prints into nothing that it opens.
#include "tests/toolchain/program.hpp"

#include <gtest/gtest.h>

namespace tappet::os {
namespace {

/// Without the standard files in `closed`, a bit for each. Its exit code is the number of the file that it
/// opened.
Ended run_without(unsigned closed) {
    std::string command = "exec " TAPPET_STANDARD_FILES_PROBE;
    for (unsigned file = 0; file < 3; ++file)
        if ((closed >> file & 1u) != 0) command += " " + std::to_string(file) + ">&-";
    return run_line(command);
}

constexpr unsigned out = 1u << 1;

TEST(StandardFiles, that_were_not_given_are_nothing_that_a_program_opens) {
    for (unsigned closed = 0; closed < 8; ++closed) {
        const int opened = run_without(closed).exit_code;
        EXPECT_GE(opened, 3) << closed;
        EXPECT_LT(opened, 126) << "it was not run";
    }
}

TEST(StandardFiles, that_were_given_stay_what_they_are) {
    for (unsigned closed = 0; closed < 8; ++closed)
        EXPECT_EQ(run_without(closed).text, (closed & out) != 0 ? "" : "printed\n") << closed;
}

} // namespace
} // namespace tappet::os
