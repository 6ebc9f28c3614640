// SPDX-License-Identifier: Apache-2.0
// A firmware in its two processes, on this host: a requested stop is complete within the board's bound, by
// the machine or, when a part of it hangs, by its guardian.
#include "kernel/machine/accept.hpp"
#include "kernel/os/arming.hpp"
#include "kernel/os/guard.hpp"
#include "kernel/os/sleep.hpp"
#include "tests/toolchain/machine/firmware_on_host.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <new>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tappet {
namespace {

enum class Ill : int {
    nothing,
    initialises_long,
    works_for_ever,
    finalises_long,
    device_takes_nothing,
    device_is_gone, ///< for its guardian as well
    supervisor_sleeps,
    supervisor_sleeps_in_stop
};

struct Page : test::WirePage {
    std::atomic<bool> runs{false}, is_ill{false};
    std::atomic<Ill> ill{Ill::nothing};
};
Page* page = nullptr;
MachineInstance* the_instance = nullptr;
constexpr auto long_time = 1700ms; // of a sleeping supervisor: the guardian misses its life after 2 s

void sleep_long() { os::sleep_for(long_time); }
/// Interrupts the main thread, wherever it is.
void put_supervisor_to_sleep() { ::syscall(SYS_tgkill, ::getpid(), ::getpid(), SIGRTMIN); }

/// First row: it stops last.
struct Valve {
    Property<std::int64_t> unused{0};
    void start(const Cycle&) noexcept TAPPET_REALTIME { page->wire = 1; }
    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        if (stopped_safely()) TAPPET_ESCAPE("a test's note", page->be_safe());
    }
    [[nodiscard]] bool stopped_safely() const noexcept TAPPET_REALTIME {
        return page->ill != Ill::device_takes_nothing && page->ill != Ill::device_is_gone;
    }
    static constexpr auto interface() {
        return facets(property<&Valve::unused>("unused", "", "a component has a facet", range(0, 0)));
    }
};

/// May block, and keeps the wire unsafe itself while it does.
struct Heater {
    Property<std::int64_t> unused{0};
    Sentence initialise() {
        if (page->ill == Ill::initialises_long) {
            page->runs = true;
            os::sleep_for(5s);
        }
        return {};
    }
    void work(const Cycle&) {
        page->runs = true;
        switch (page->ill) {
        case Ill::works_for_ever:
            page->is_ill = true;
            for (;;) {
                os::sleep_for(1ms);
                page->wire = 1;
            }
        case Ill::supervisor_sleeps:
            if (page->is_ill.exchange(true)) break;
            put_supervisor_to_sleep();
            os::sleep_for(50ms);
            the_instance->ask_stop(StopReason::requested, 0, nullptr);
            break;
        default: break;
        }
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        if (page->ill == Ill::supervisor_sleeps_in_stop)
            TAPPET_ESCAPE("this activity is not real-time", put_supervisor_to_sleep(); os::sleep_for(50ms));
    }
    void finalise() {
        if (page->ill == Ill::finalises_long) os::sleep_for(3s);
    }
    static constexpr auto interface() {
        return facets(property<&Heater::unused>("unused", "", "a component has a facet", range(0, 0)));
    }
};

// clang-format off
constexpr auto table = machine("guarded",
    components(component<Valve>("valve"), component<Heater>("heater")),
    activities(
        activity("drivers", every(5ms),  runs("valve"),  budget(50us)),
        activity("heat",    every(10ms), runs("heater"), not_real_time)),
    connections(), reactions(), behaviours());
// clang-format on
constexpr const Board& board = test::board_of_host;

struct AFirmware : testing::Test {
    pid_t guardian = -1;

    void SetUp() override {
        if (os::observe_process(board.highest_priority).fifo_error != 0)
            GTEST_SKIP() << "SCHED_FIFO is not granted here: run as root";
        page = test::shared_page<Page>();
    }
    void run(Ill ill) {
        page->ill = ill;
        guardian = ::fork();
        if (guardian == 0)
            test::be_firmware(AtRunTime<table, test::board_of_host>::machine(), *page,
                              {.configured = [](MachineInstance& instance) {
                                  the_instance = &instance;
                                  ::signal(SIGRTMIN,
                                           [](int) { sleep_long(); }); // instead of asking for the stop
                              }});
        ASSERT_TRUE(becomes([] { return page->runs && page->wire == 1; }));
    }
    template <class Condition> static bool becomes(Condition condition) {
        for (int n = 0; n < 20'000 && !condition(); ++n) os::sleep_for(1ms);
        return condition();
    }
    void ask() {
        page->is_gone = page->ill == Ill::device_is_gone;
        page->asked = to_ns(os::Clock::monotonic());
        ::kill(guardian, SIGTERM); // the guardian hands it on
    }
    /// Time from the request until the outputs are safe.
    [[nodiscard]] Duration until_safe() {
        EXPECT_TRUE(becomes([] { return page->wire == 0; }));
        return at_ns(page->safe_since) - at_ns(page->asked);
    }
    int exit_code() const {
        int status = 0;
        ::waitpid(guardian, &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    /// The board's bound, plus the delivery of the request and the guardian's polling on a busy host.
    static constexpr Duration bound = board.stop_within + 200ms;
    static_assert(bound < long_time, "who waits for a supervisor that sleeps is late");
};

/// A fault before the stop, the exit code, and whether the guardian also writes the outputs.
struct Asked {
    const char* name;
    Ill ill;
    int exit_code;
    bool by_guardian;
};
void PrintTo(const Asked& row, std::ostream* out) { *out << row.name; }
struct AskedToStop : AFirmware, testing::WithParamInterface<Asked> {};
INSTANTIATE_TEST_SUITE_P(
    firmware, AskedToStop,
    testing::Values(Asked{"does_so_itself_and_ends_well", Ill::nothing, 0, false},
                    Asked{"while_it_starts_is_safe_before_the_initialising_has_come_to_its_end",
                          Ill::initialises_long, 0, false},
                    Asked{"whose_finalising_takes_long_is_safe_before_it", Ill::finalises_long, 0, false},
                    Asked{
                        "whose_device_took_no_safe_values_is_made_safe_by_its_guardian_after_its_orderly_end",
                        Ill::device_takes_nothing, 0, true},
                    Asked{"whose_supervisor_does_not_come_to_the_end_of_a_stop_is_made_safe_by_its_guardian",
                          Ill::supervisor_sleeps_in_stop, 128 + SIGKILL, true}),
    [](const auto& row) { return std::string{row.param.name}; });

TEST_P(AskedToStop, outputs_are_safe_in_time) {
    ASSERT_NO_FATAL_FAILURE(run(GetParam().ill));
    ask();
    EXPECT_LT(until_safe(), bound);
    EXPECT_EQ(exit_code(), GetParam().exit_code);
    EXPECT_EQ(page->by_guardian > 0, GetParam().by_guardian);
}

TEST_F(AFirmware, does_not_end_as_good_when_its_device_is_gone) {
    ASSERT_NO_FATAL_FAILURE(run(Ill::device_is_gone));
    ask();
    EXPECT_EQ(exit_code(), static_cast<int>(Ending::stopped_by_fault));
    EXPECT_EQ(page->wire, 1);
    EXPECT_GT(page->by_guardian, 0);
}

TEST_F(AFirmware, stops_itself_when_its_guardian_hangs_at_start) {
    ASSERT_NO_FATAL_FAILURE(run(Ill::initialises_long));
    page->asked = to_ns(os::Clock::monotonic());
    ::kill(guardian, SIGSTOP);
    EXPECT_LT(until_safe(), os::Guard::guardian_within + bound);
    ::kill(guardian, SIGCONT);
    EXPECT_EQ(exit_code(), static_cast<int>(Ending::stopped_by_fault));
}

TEST_F(AFirmware, is_ended_by_its_guardian_when_an_activity_hangs) {
    ASSERT_NO_FATAL_FAILURE(run(Ill::works_for_ever));
    ASSERT_TRUE(becomes([] { return page->is_ill.load(); }));
    ask();
    EXPECT_TRUE(becomes([] { return page->by_guardian > 0; }));
    EXPECT_LT(until_safe(), bound);
    EXPECT_EQ(exit_code(), 128 + SIGKILL);
    EXPECT_EQ(page->wire, 0) << "who would have written it is no more";
}

TEST_F(AFirmware, is_made_safe_by_its_guardian_when_its_supervisor_ignores_a_stop) {
    ASSERT_NO_FATAL_FAILURE(run(Ill::supervisor_sleeps));
    ASSERT_TRUE(becomes([] { return page->is_ill.load(); }));
    page->asked = to_ns(os::Clock::monotonic());
    EXPECT_LT(until_safe(), board.stop_begins_within() + 250ms);
    EXPECT_EQ(exit_code(), 128 + SIGKILL);
    EXPECT_GT(page->by_guardian, 0);
}

} // namespace
} // namespace tappet
