// The watch of real-time code on a host: it sees the heap, locks and system calls, and changes none of them.
#include "kernel/os/host_watch.hpp"

#include <gmock/gmock.h>

#include <cerrno>
#include <csignal>
#include <mutex>
#include <vector>

#include <sys/syscall.h>
#include <unistd.h>

namespace tappet {

// Not in an unnamed namespace, because the watch names exported functions.
[[gnu::noinline]] void allocate_in_a_step(std::vector<int>& list) { list.push_back(1); }
[[gnu::noinline]] void lock_in_a_step(std::mutex& mutex) { const std::lock_guard hold{mutex}; }
[[gnu::noinline]] ssize_t read_in_a_step(int descriptor, char* into) { return ::read(descriptor, into, 4); }

volatile int quotient = 0;
[[gnu::noinline]] void divide_in_a_step(int by) { quotient = 4711 / by; }
volatile bool goes_on = true;
[[gnu::noinline]] int recurse_in_a_step(int depth) { // NOLINT: it overflows
    if (!goes_on) return 0;
    volatile char used[4096];
    used[0] = static_cast<char>(depth);
    return recurse_in_a_step(depth + 1) + used[0];
}
[[gnu::noinline]] void loop_in_a_step() {
    while (goes_on) {
    }
}

namespace {

namespace watch = os::host_watch;
using testing::HasSubstr;

class Watch : public testing::Test {
protected:
    static void SetUpTestSuite() { sees_calls = watch::prepare("loom"); }

    /// Runs a cycle, and returns the record that it made or counted; null: none.
    template <class Cycle>
    const watch::Use* cycle(Cycle&& run) {
        std::array<std::uint64_t, watch::max_uses> before{};
        for (std::size_t i = 0; i < watch::uses().size(); ++i) before[i] = watch::uses()[i].cycles;
        watch::enter("motion", true);
        run();
        watch::leave();
        for (std::size_t i = 0; i < watch::uses().size(); ++i)
            if (watch::uses()[i].cycles != before[i]) return &watch::uses()[i];
        return nullptr;
    }

    static inline bool sees_calls = false;
};

TEST_F(Watch, sees_the_heap_and_names_the_function) {
    std::vector<int> list;
    const watch::Use* use = cycle([&] { allocate_in_a_step(list); });
    ASSERT_NE(use, nullptr);
    EXPECT_EQ(use->what, "malloc");
    EXPECT_EQ(use->activity, "motion");
    EXPECT_THAT(watch::place_of(*use).view(), HasSubstr("allocate_in_a_step"));
    EXPECT_EQ(list.size(), 1u);
}

TEST_F(Watch, sees_a_lock_that_nobody_else_holds) {
    std::mutex mutex;
    const watch::Use* use = cycle([&] { lock_in_a_step(mutex); });
    ASSERT_NE(use, nullptr);
    EXPECT_EQ(use->what, "pthread_mutex_lock");
    EXPECT_THAT(watch::place_of(*use).view(), HasSubstr("lock_in_a_step"));
}

TEST_F(Watch, sees_a_system_call_and_leaves_its_result_alone) {
    if (!sees_calls) GTEST_SKIP() << "this kernel cannot show system calls";
    int ends[2] = {-1, -1};
    ASSERT_EQ(::pipe(ends), 0);
    ASSERT_EQ(::write(ends[1], "weft", 4), 4);
    char got[5] = {};
    ssize_t count = 0;
    const watch::Use* use = cycle([&] { count = read_in_a_step(ends[0], got); });
    ASSERT_NE(use, nullptr);
    EXPECT_EQ(use->what, "the system call read");
    EXPECT_THAT(watch::place_of(*use).view(), HasSubstr("read_in_a_step"));
    EXPECT_EQ(count, 4);
    EXPECT_STREQ(got, "weft");
    errno = 0;
    use = cycle([&] { count = read_in_a_step(-1, got); });
    EXPECT_EQ(count, -1);
    EXPECT_EQ(errno, EBADF);
    ::close(ends[0]);
    ::close(ends[1]);
}

TEST_F(Watch, counts_cycles_at_a_place_and_records_the_first_use_of_each) {
    std::mutex mutex;
    std::vector<int> list;
    const std::uint64_t before = watch::cycles();
    const watch::Use* use = nullptr;
    for (int i = 0; i < 3; ++i) {
        use = cycle([&] {
            lock_in_a_step(mutex);
            std::vector<int>{}.swap(list);
            allocate_in_a_step(list);
        });
        ASSERT_NE(use, nullptr);
        EXPECT_EQ(use->what, "pthread_mutex_lock");
    }
    EXPECT_EQ(watch::cycles(), before + 3);
}

TEST_F(Watch, is_silent_about_cycles_that_cannot_block_and_about_code_outside_of_cycles) {
    int sum = 0;
    EXPECT_EQ(cycle([&] {
                  for (int i = 0; i < 1000; ++i) sum += i;
              }),
              nullptr);
    const std::uint64_t before = watch::cycles();
    std::vector<int> list;
    allocate_in_a_step(list);
    static_cast<void>(::getppid());
    EXPECT_EQ(watch::cycles(), before);
    EXPECT_EQ(sum, 499'500);
}

TEST_F(Watch, does_not_see_calls_in_a_cycle_that_is_not_real_time) {
    std::mutex mutex;
    const std::uint64_t before = watch::cycles();
    watch::enter("office", false);
    lock_in_a_step(mutex);
    static_cast<void>(::getppid());
    watch::leave();
    EXPECT_EQ(watch::cycles(), before);
}

volatile bool was_told = false;

TEST_F(Watch, lets_other_signals_handlers_return) {
    struct sigaction action{}, before{};
    action.sa_handler = [](int) { was_told = true; };
    ASSERT_EQ(::sigaction(SIGUSR1, &action, &before), 0);
    static_cast<void>(cycle([] { ::raise(SIGUSR1); }));
    EXPECT_TRUE(was_told);
    ::sigaction(SIGUSR1, &before, nullptr);
}

TEST_F(Watch, ends_a_program_that_divides_by_zero_with_activity_and_function) {
    EXPECT_EXIT(cycle([] { divide_in_a_step(0); }), testing::KilledBySignal(SIGFPE),
                "loom: signal FPE in activity \"motion\", in tappet::divide_in_a_step");
}

TEST_F(Watch, ends_a_program_whose_stack_is_used_up) {
    EXPECT_EXIT(cycle([] { recurse_in_a_step(1); }), testing::KilledBySignal(SIGSEGV),
                "loom: signal SEGV in activity \"motion\", in tappet::recurse_in_a_step");
}

TEST_F(Watch, ends_a_program_with_a_cycle_that_does_not_end) {
    const auto run = [this] {
        watch::prepare("loom", 2); // a child of fork has no timer
        cycle([] { loop_in_a_step(); });
    };
    EXPECT_EXIT(run(), testing::KilledBySignal(SIGABRT),
                "loom: a cycle has used 2 s of processor time and does not end in activity \"motion\", in "
                "tappet::loop_in_a_step");
}

TEST_F(Watch, names_a_fault_outside_of_cycles_as_such) {
    EXPECT_EXIT(divide_in_a_step(0), testing::KilledBySignal(SIGFPE),
                "FPE outside of the machine's cycles, in ");
}

} // namespace
} // namespace tappet
