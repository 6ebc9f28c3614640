// SPDX-License-Identifier: Apache-2.0
// Two processes of one program: what the guardian and the machine learn of each other.
#include "kernel/os/guard.hpp"

#include "kernel/os/sleep.hpp"
#include "kernel/os/thread.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>

#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tappet::os {
namespace {

using Seen = Guard::Seen;

/// Splits a process of its own; its exit code is the result of `guardian`, or on the machine's side that of
/// `machine`.
/// `machine` does.
constexpr int kept_open[] = {3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16}; // the test reads from it
template <class Machine, class Guardian>
int split(Machine machine, Guardian guardian, std::string_view refusal = {}, int crash_patience_ms = 60'000) {
    const pid_t child = ::fork();
    if (child == 0) {
        Guard guard;
        const auto side = guard.split(crash_patience_ms);
        if (!side) std::_Exit(99);
        if (*side == Guard::Side::machine) std::_Exit(machine(guard));
        static_cast<void>(guard.become_guardian(kept_open)); // run the rest where FIFO is not granted
        if (refusal.empty())
            guard.be_ready();
        else
            guard.refuse(Sentence{refusal});
        std::_Exit(guardian(guard));
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}
/// The first result other than nothing.
Seen next(Guard& guard) {
    for (;;)
        if (const Seen seen = guard.look(20ms); seen != Seen::nothing) return seen;
}
int code_at_the_end(Guard& guard) {
    while (next(guard) != Seen::end) {
    }
    return guard.exit_code();
}
void await_activities(Guard& guard) {
    while (!guard.block().activities_run && guard.look(1ms) != Seen::end) {
    }
}

int arm(Guard& guard) {
    if (!guard.wait_for_guardian().empty()) return 98;
    guard.be_back_within(1h);
    guard.let_activities_be_watched(true);
    return 0;
}

int arm_and_die(Guard& guard) {
    if (arm(guard) != 0) return 98;
    ::kill(::getpid(), SIGKILL);
    return 0;
}

TEST(Guard, returns_the_exit_code_of_a_machine_that_ended_well) {
    const int code = split(
        [](Guard& guard) {
            if (arm(guard) != 0) return 98;
            guard.end(Guard::Outputs::safe, {});
            return 4;
        },
        [](Guard& guard) {
            const int code_told = code_at_the_end(guard);
            return guard.block().ended_well && guard.block().activities_run ? code_told : 97;
        });
    EXPECT_EQ(code, 4);
}

TEST(Guard, reports_a_silent_death_and_its_signal) {
    const int code = split(arm_and_die, [](Guard& guard) {
        const Seen first = next(guard);
        if (first != Seen::dying && first != Seen::end) return 96;
        if (!guard.await_end(1h) || guard.block().ended_well) return 95;
        return guard.exit_code();
    });
    EXPECT_EQ(code, 128 + SIGKILL);
}

TEST(Guard, detects_the_end_of_a_machine_although_sigchld_is_ignored) {
    const auto kept = ::signal(SIGCHLD, SIG_IGN);
    int told[2];
    ASSERT_EQ(::pipe(told), 0);
    static_cast<void>(split(arm_and_die, [&](Guard& guard) {
        const int code = code_at_the_end(guard);
        return static_cast<int>(::write(told[1], &code, sizeof code)); // its own parent is not notified
    }));
    int code = 0;
    EXPECT_EQ(::read(told[0], &code, sizeof code), static_cast<ssize_t>(sizeof code));
    EXPECT_EQ(code, 128 + SIGKILL);
    ::signal(SIGCHLD, kept);
    ::close(told[0]);
    ::close(told[1]);
}

[[gnu::noinline]] int crash_here() { return ::raise(SIGSEGV) + 1; }

TEST(Guard, reports_a_crash_and_its_thread_before_the_process_ends) {
    const int code = split(
        [](Guard& guard) {
            if (arm(guard) != 0) return 98;
            return crash_here();
        },
        [](Guard& guard) {
            if (next(guard) != Seen::crash) return 94;
            const CrashNote& note = guard.block().crash;
            if (!note.is_complete() || note.signal != SIGSEGV || note.instruction == 0) return 93;
            if (note.describe().view().find("SEGV at instruction 0x") != 0) return 92;
            const auto begin = reinterpret_cast<std::uint64_t>(&crash_here);
            if (std::ranges::none_of(note.returns, [&](auto at) { return at - begin < 100; })) return 89;
            guard.kill();
            return guard.await_end(1h) ? guard.exit_code() : 91;
        });
    EXPECT_EQ(code, 128 + SIGKILL) << "the crashed thread sleeps until the guardian ends it";
}

/// Uses so many bytes of its stack in frames of that size, writes to the lowest of each, and makes the write
/// visible to the compiler.
template <std::size_t frame>
[[gnu::noinline]] int use_stack(std::size_t bytes, const volatile std::byte* above) {
    volatile std::byte room[frame];
    room[0] = above == nullptr ? std::byte{1} : above[0];
    return bytes <= frame ? 1 : use_stack<frame>(bytes - frame, room) + static_cast<int>(room[0]);
}

class StackUsedUp : public testing::TestWithParam<int (*)(std::size_t, const volatile std::byte*)> {};

TEST_P(StackUsedUp, is_reported_without_a_write_below_the_stack) {
    static ParamType use;
    use = GetParam();
    struct Below {
        alignas(4096) std::array<std::byte, 16 * 4096> neighbour{};
        std::array<std::byte, 64 * 1024> stack{};
    };
    static Below* memory;
    memory = static_cast<Below*>(
        ::mmap(nullptr, sizeof(Below), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
    const int code = split(
        [](Guard& guard) {
            if (arm(guard) != 0) return 98;
            static const ThreadPlan plan{.name = "deep", .stack = memory->stack, .body = [](void*) noexcept {
                                             use(sizeof memory->stack, nullptr);
                                         }};
            Thread thread;
            if (!thread.start(plan)) return 97;
            thread.join();
            return 96;
        },
        [](Guard& guard) {
            if (next(guard) != Seen::crash) return 94;
            const Sentence told = guard.block().crash.describe();
            if (told.view().find("in thread \"deep\", whose stack of 65536 bytes is used up") ==
                std::string_view::npos)
                return 93;
            if (std::ranges::any_of(memory->neighbour, [](std::byte each) { return each != std::byte{}; }))
                return 92;
            guard.kill();
            return guard.await_end(1h) ? guard.exit_code() : 91;
        });
    EXPECT_EQ(code, 128 + SIGKILL);
    ::munmap(memory, sizeof(Below));
}
constexpr const char* frames[] = {"a_quarter_of_a_page", "nine_pages", "nearly_the_whole_stack"};
INSTANTIATE_TEST_SUITE_P(in_frames_of, StackUsedUp,
                         testing::Values(&use_stack<1024>, &use_stack<9 * 4096>, &use_stack<60 * 1024>),
                         [](const auto& each) { return frames[each.index]; });

TEST(Guard, lets_an_unhandled_crash_end_the_process) {
    const int code = split(
        [](Guard& guard) {
            if (arm(guard) != 0) return 98;
            ::raise(SIGFPE);
            return 0;
        },
        [](Guard& guard) { return guard.await_end(1h) ? guard.exit_code() : 90; }, {}, 10);
    EXPECT_EQ(code, 128 + SIGFPE);
}

TEST(Guard, isolates_the_failures_of_a_trial) {
    const int code = split([](Guard& guard) { return arm(guard); },
                           [](Guard& guard) {
                               int here = 0;
                               if (!guard.try_apart(1h, [&] { here = 1; }) || here != 0) return 95;
                               if (guard.try_apart(1h, [] { __builtin_trap(); })) return 94;
                               if (guard.try_apart(10ms, [] { ::pause(); })) return 93;
                               return guard.await_end(1h) ? guard.exit_code() : 91;
                           });
    EXPECT_EQ(code, 0);
}

TEST(Guard, forwards_signals_sent_to_it) {
    const int code = split(
        [](Guard& guard) {
            static sig_atomic_t volatile asked = 0;
            ::signal(SIGTERM, [](int) { asked = 1; });
            if (arm(guard) != 0) return 98;
            while (asked == 0) sleep_for(1ms);
            guard.end(Guard::Outputs::safe, {});
            return 7;
        },
        [](Guard& guard) {
            await_activities(guard); // then its handler is installed
            ::kill(::getpid(), SIGTERM);
            return code_at_the_end(guard);
        });
    EXPECT_EQ(code, 7);
}

TEST(Guard, shows_the_machine_that_the_guardian_has_died) {
    int told[2];
    ASSERT_EQ(::pipe(told), 0);
    const int code = split(
        [&](Guard& guard) {
            ::signal(SIGTERM, SIG_IGN); // which requests the orderly stop
            if (arm(guard) != 0) return 98;
            while (!guard.guardian_is_lost()) sleep_for(1ms);
            return static_cast<int>(::write(told[1], "gone", 4)) - 4;
        },
        [](Guard& guard) {
            await_activities(guard);
            return 42;
        });
    EXPECT_EQ(code, 42);
    char text[4] = {};
    EXPECT_EQ(::read(told[0], text, sizeof text), 4);
    ::close(told[0]);
    ::close(told[1]);
}

TEST(Guard, shows_the_machine_that_the_guardian_has_stopped_looking) {
    const int code = split(
        [](Guard& guard) {
            if (arm(guard) != 0) return 98;
            while (!guard.guardian_is_lost()) sleep_for(1ms);
            guard.end(Guard::Outputs::safe, {});
            return 5;
        },
        [](Guard& guard) {
            static_cast<void>(guard.look(1ms));
            while (!guard.await_end(1s)) {
            }
            return guard.exit_code();
        });
    EXPECT_EQ(code, 5);
}

TEST(Guard, reports_why_the_guardian_cannot_act) {
    const int code =
        split([](Guard& guard) { return guard.wait_for_guardian().view() == "no wires" ? 3 : 89; },
              code_at_the_end, "no wires");
    EXPECT_EQ(code, 3);
}

} // namespace
} // namespace tappet::os
