// Which messages PID 1 accepts.
#include "board/box/ears.hpp"

#include "kernel/os/notify.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tappet::box {
namespace {

/// Runs in a process and a network of its own, since a box has only one init.
std::string heard_of(uid_t sender) {
    Ears ears;
    if (::unshare(CLONE_NEWNET) != 0 || !ears.open()) return "nothing could be heard";
    if (const pid_t child = ::fork(); child == 0) {
        if (::setresuid(sender, sender, sender) != 0) ::_exit(1);
        os::notify_starter("X_TAPPET_PROVEN=1");
        ::_exit(0);
    } else {
        ::waitpid(child, nullptr, 0);
    }
    std::string heard;
    ears.take_notices([&](std::string_view notice) { heard += notice; });
    return heard;
}

TEST(Ears, ignore_processes_of_other_users) {
    if (::getuid() != 0) GTEST_SKIP() << "needs two users";
    const auto hears = [](uid_t sender, const char* wanted) { ::_exit(heard_of(sender) == wanted ? 0 : 1); };
    EXPECT_EXIT(hears(0, "X_TAPPET_PROVEN=1"), testing::ExitedWithCode(0), "");
    EXPECT_EXIT(hears(65534, ""), testing::ExitedWithCode(0), "");
}

/// A pipe holds more than init reads at a time: a program that prints without end does not delay the rest.
TEST(Ears, read_printed_text_in_bounded_portions) {
    if (::getuid() != 0) GTEST_SKIP() << "needs a network of its own";
    const auto takes_some = [] {
        Ears ears;
        if (::unshare(CLONE_NEWNET) != 0 || !ears.open()) ::_exit(1);
        const std::string text(4096, 'x');
        std::size_t taken = 0, times = 0;
        ears.take_prints([&](std::string_view) { ::_exit(2); });
        for (int i = 0; i < 8; ++i)
            if (::write(ears.mouth(), text.data(), text.size()) < 0) ::_exit(3);
        ears.take_prints([&](std::string_view piece) {
            taken += piece.size();
            // A program that prints as fast as init reads.
            if (++times > 1000 || ::write(ears.mouth(), text.data(), text.size()) < 0) ::_exit(4);
        });
        ::_exit(taken > 0 ? 0 : 5);
    };
    EXPECT_EXIT(takes_some(), testing::ExitedWithCode(0), "");
}

} // namespace
} // namespace tappet::box
