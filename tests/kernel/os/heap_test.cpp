// The sealed heap, seen from outside: a static program that allocates after sealing is detected by any way of
// allocation.
#include "kernel/os/heap.hpp"

#include "tests/toolchain/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tappet::os::heap {
namespace {

constexpr int broken = 3, aborted = 128 + 6;

/// The program runs the action, ends with the code, and prints all of `says`.
void expect_ending(const std::string& action, int exit_code, std::initializer_list<const char*> says) {
    const Ended ended = run_line("( exec " TAPPET_HEAP_PROBE " " + action + " )"); // a signal becomes a code
    EXPECT_EQ(ended.exit_code, exit_code) << action << "\n" << ended.text;
    for (const char* each : says) EXPECT_THAT(ended.text, testing::HasSubstr(each)) << action;
}

TEST(SealedHeap, lets_a_program_without_further_allocations_run) {
    for (const char* action : {"nothing", "stack"}) expect_ending(action, 0, {"allocations 0 mappings 0"});
}

class AllocatesAfterSealing : public ::testing::TestWithParam<const char*> {};

TEST_P(AllocatesAfterSealing, is_counted_and_recorded_and_breaks_a_contract) {
    expect_ending(GetParam(), broken, {"allocations 1 ", "contract 201", " bytes by "});
}

INSTANTIATE_TEST_SUITE_P(Ways, AllocatesAfterSealing,
                         ::testing::Values("malloc", "calloc", "realloc", "aligned_alloc", "memalign",
                                           "posix_memalign", "new", "new_array", "new_aligned", "string",
                                           "strdup", "fopen", "thread"),
                         [](const auto& way) { return std::string{way.param}; });

class MapsAfterSealing : public ::testing::TestWithParam<const char*> {};

TEST_P(MapsAfterSealing, is_refused_and_breaks_a_contract) {
    expect_ending(GetParam(), broken, {"mappings 1 ", "contract 202"});
}

INSTANTIATE_TEST_SUITE_P(Ways, MapsAfterSealing, ::testing::Values("mmap", "sbrk", "thread_stack"),
                         [](const auto& way) { return std::string{way.param}; });

TEST(SealedHeap, ends_a_program_without_a_handler) {
    expect_ending("unhandled", aborted, {"contract 201 allocation-after-seal: 10 bytes were allocated"});
}

TEST(Heap, reports_the_remaining_bytes_when_it_is_exhausted) {
    expect_ending("exhaust", aborted, {"contract 203 heap-exhausted: 10000 bytes were requested"});
}

TEST(Heap, returns_null_when_exhausted_with_a_handler) {
    expect_ending("exhaust_handled", broken, {"contract 203 refused 1"});
}

TEST(Heap, stops_only_the_thread_that_needs_memory) {
    expect_ending("exhaust_new", broken, {"contract 208, and the process goes on"});
}

TEST(Heap, refuses_a_second_free_and_a_foreign_pointer) {
    expect_ending("free_twice", aborted, {"contract 205 heap-double-free"});
    expect_ending("free_foreign", aborted, {"contract 204 heap-foreign-pointer"});
}

TEST(Heap, detects_that_a_program_does_not_use_it) {
    EXPECT_FALSE(owns_malloc()) << "this test is linked without tappet_sealed_heap";
    seal();
    EXPECT_EQ(state(), State::sealed);
    EXPECT_FALSE(seal_counts());
    release();
    EXPECT_EQ(state(), State::released);
}

} // namespace
} // namespace tappet::os::heap
