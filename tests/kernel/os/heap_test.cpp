// The sealed heap, seen from outside: a static program that allocates after sealing is caught, whatever way
// it takes.
#include "kernel/os/heap.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <string>

#include <sys/wait.h>

namespace tappet::os::heap {
namespace {

struct Ending {
    std::string output;
    int exit_code = -1; // of the program, 128 + signal when one ended it
};

Ending run_probe(const std::string& action) {
    // The shell turns a signal into an exit code and keeps standard error.
    const std::string command = "( exec " TAPPET_HEAP_PROBE " " + action + " ) 2>&1";
    Ending ending;
    FILE* pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) return ending;
    std::array<char, 512> part{};
    while (std::fgets(part.data(), part.size(), pipe) != nullptr) ending.output += part.data();
    const int status = pclose(pipe);
    ending.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return ending;
}

constexpr int broken = 3, aborted = 128 + 6;

TEST(SealedHeap, lets_a_program_run_that_allocates_no_more) {
    for (const char* action : {"nothing", "stack"}) {
        const Ending ending = run_probe(action);
        EXPECT_EQ(ending.exit_code, 0) << action << "\n" << ending.output;
        EXPECT_NE(ending.output.find("allocations 0 mappings 0"), std::string::npos) << ending.output;
    }
}

class AllocatesAfterSealing : public ::testing::TestWithParam<const char*> {};

TEST_P(AllocatesAfterSealing, is_counted_recorded_and_a_broken_contract) {
    const Ending ending = run_probe(GetParam());
    EXPECT_EQ(ending.exit_code, broken) << ending.output;
    EXPECT_NE(ending.output.find("allocations 1 "), std::string::npos) << ending.output;
    EXPECT_NE(ending.output.find("contract 201"), std::string::npos) << ending.output;
    EXPECT_NE(ending.output.find(" bytes by "), std::string::npos) << "it says who: " << ending.output;
}

INSTANTIATE_TEST_SUITE_P(Ways, AllocatesAfterSealing,
                         ::testing::Values("malloc", "calloc", "realloc", "aligned_alloc", "memalign",
                                           "posix_memalign", "new", "new_array", "new_aligned", "string",
                                           "strdup", "fopen", "thread"),
                         [](const auto& way) { return std::string{way.param}; });

class MapsAfterSealing : public ::testing::TestWithParam<const char*> {};

TEST_P(MapsAfterSealing, is_refused_and_a_broken_contract) {
    const Ending ending = run_probe(GetParam());
    EXPECT_EQ(ending.exit_code, broken) << ending.output;
    EXPECT_NE(ending.output.find("mappings 1 "), std::string::npos) << ending.output;
    EXPECT_NE(ending.output.find("contract 202"), std::string::npos) << ending.output;
}

INSTANTIATE_TEST_SUITE_P(Ways, MapsAfterSealing, ::testing::Values("mmap", "sbrk", "thread_stack"),
                         [](const auto& way) { return std::string{way.param}; });

TEST(SealedHeap, ends_a_program_without_a_handler) {
    const Ending ending = run_probe("unhandled");
    EXPECT_EQ(ending.exit_code, aborted);
    EXPECT_NE(ending.output.find("contract 201 allocation-after-seal: 10 bytes were allocated"),
              std::string::npos)
        << ending.output;
}

TEST(Heap, says_how_much_is_left_when_it_is_exhausted) {
    const Ending ending = run_probe("exhaust");
    EXPECT_EQ(ending.exit_code, aborted);
    EXPECT_NE(ending.output.find("contract 203 heap-exhausted: 10000 bytes were asked"), std::string::npos)
        << ending.output;
}

TEST(Heap, gives_null_when_it_is_exhausted_and_a_handler_knows) {
    const Ending ending = run_probe("exhaust_handled");
    EXPECT_NE(ending.output.find("contract 203 refused 1"), std::string::npos) << ending.output;
}

TEST(Heap, stops_the_thread_that_cannot_go_on_without_memory_and_not_the_process) {
    const Ending ending = run_probe("exhaust_new");
    EXPECT_EQ(ending.exit_code, broken) << ending.output;
    EXPECT_NE(ending.output.find("contract 208, and the process goes on"), std::string::npos)
        << ending.output;
}

TEST(Heap, refuses_a_second_free_and_a_foreign_pointer) {
    EXPECT_NE(run_probe("free_twice").output.find("contract 205 heap-double-free"), std::string::npos);
    EXPECT_NE(run_probe("free_foreign").output.find("contract 204 heap-foreign-pointer"), std::string::npos);
}

TEST(Heap, knows_that_a_program_does_not_use_it) {
    EXPECT_FALSE(owns_malloc()) << "this test is linked without tappet_sealed_heap";
    seal();
    EXPECT_EQ(state(), State::sealed);
    EXPECT_FALSE(seal_counts());
    release();
    EXPECT_EQ(state(), State::released);
}

} // namespace
} // namespace tappet::os::heap
