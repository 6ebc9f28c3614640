// Wait-freedom in the object code of this tree's compiler (thesis 4.4, 4.6: bounded communication in real
// time): every operation between activities has counted loops only, and the versions that retry are refused.
#include "tests/waitfree/loops.hpp"

#include <gtest/gtest.h>

#include <iostream>
#include <sstream>

namespace tappet::waitfree {
namespace {

const Program& program() {
    static const Program all = [] {
        std::vector<std::string> objects;
        std::istringstream list{TAPPET_OBJECTS};
        for (std::string object; std::getline(list, object, '|');) objects.push_back(object);
        return disassemble(objects);
    }();
    return all;
}

/// Copies whose length is passed along; the operating system, which wakes a sleeping thread.
const Permission plain{{"memcpy", "memset", "memmove"}, false};
const Permission calling{plain.outside, true};
const Permission waking{{"syscall", "write"}, false};
/// A broken contract ends the thread: its actions then are no steps of the operation.
const Permission sending{
    {"memcpy", "memset", "memmove", "_ZN6tappet14break_contractERKNS_17ContractViolationE"}, true};
/// The end of a command wakes the waiting caller, besides the component's own actions.
const Permission ending{{"memcpy", "memset", "memmove", "syscall", "write"}, true};

struct Claim {
    std::string operation;
    Permission permission;
};
void PrintTo(const Claim& claim, std::ostream* out) { *out << claim.operation; }

class Operation : public testing::TestWithParam<Claim> {};

TEST_P(Operation, has_only_counted_loops) {
    const auto& [operation, permission] = GetParam();
    ASSERT_FALSE(program().empty()) << "objdump shows nothing; ci/setup installs it with the compiler";
    const Verdict verdict = check(program(), operation, permission);
    for (const std::string& fault : verdict.faults) ADD_FAILURE() << fault;
    std::cout << operation << ": " << verdict.functions.size()
              << (verdict.functions.size() == 1 ? " function" : " functions");
    for (const Loop& loop : verdict.loops)
        std::cout << ", a loop counted by " << loop.counter << " to "
                  << (loop.passes ? std::to_string(*loop.passes) : "a bound that stays");
    for (const std::string& each : verdict.outside) std::cout << ", calls " << each;
    if (verdict.makes_given_calls) std::cout << ", calls its handlers";
    std::cout << "\n";
}

// clang-format off
INSTANTIATE_TEST_SUITE_P(
    BetweenActivities, Operation,
    testing::Values(
        Claim{"data_object_write_number", plain}, Claim{"data_object_read_number", plain},
        Claim{"data_object_write_frame", plain},  Claim{"data_object_read_frame", plain},
        Claim{"ring_push_number", plain},         Claim{"ring_pop_number", plain},
        Claim{"ring_push_frame", plain},          Claim{"ring_pop_frame", plain},
        Claim{"ring_lost", plain},
        Claim{"inbox_post", plain},               Claim{"inbox_pending", plain},         Claim{"inbox_serve", calling},
        Claim{"latest_put", plain},               Claim{"latest_take", plain},
        Claim{"waiter_wake", waking},             Claim{"waiter_take", plain},
        Claim{"tape_mark", plain},                Claim{"tape_end", plain},              Claim{"tape_read", plain},
        Claim{"values_record", plain},            Claim{"values_read", plain},
        Claim{"output_write", calling},           Claim{"input_read", plain},
        Claim{"buffer_push", calling},            Claim{"buffer_pop", plain},
        Claim{"event_emit", calling},             Claim{"event_post", calling},
        Claim{"event_connect", plain},            Claim{"event_disconnect", plain},
        Claim{"command_send", sending},           Claim{"command_state", plain},         Claim{"command_reset", plain},
        Claim{"command_begin", ending},           Claim{"command_follow", ending},       Claim{"command_take_up", ending},
        Claim{"command_fail_all", ending},        Claim{"command_reject_all", ending},
        Claim{"life_ask", plain},                 Claim{"life_take", plain},             Claim{"life_answer", plain}),
    [](const auto& one) { return one.param.operation; });
// clang-format on

class Retry : public testing::TestWithParam<std::string> {};

TEST_P(Retry, is_refused) {
    const Verdict verdict = check(program(), GetParam(), calling);
    EXPECT_FALSE(verdict.faults.empty()) << GetParam() << " goes on as long as others make it";
    for (const std::string& fault : verdict.faults) std::cout << fault << "\n";
}

#if defined(__aarch64__)
constexpr const char* made_by_the_compiler = "retry_add_without_lse";
TEST(Check, accepts_an_atomic_operation_that_is_one_instruction) {
    EXPECT_TRUE(check(program(), "retry_set_bit", plain).faults.empty());
}
#else
constexpr const char* made_by_the_compiler = "retry_set_bit";
#endif

INSTANTIATE_TEST_SUITE_P(Deliberate, Retry,
                         testing::Values("retry_push", made_by_the_compiler, "retry_wait_for_flag",
                                         "retry_read", "retry_while_more_comes",
                                         "retry_with_a_counter_that_is_set_back", "retry_by_recursion"),
                         [](const auto& one) { return one.param; });

TEST(Check, finds_the_loop_of_a_sum_and_its_count) {
    const Verdict verdict = check(program(), "counted_sum", plain);
    EXPECT_TRUE(verdict.faults.empty());
    for (const Loop& loop : verdict.loops) EXPECT_LE(loop.passes.value_or(~std::uint64_t{0}), 40u);
}

TEST(Check, refuses_a_missing_function_and_one_with_unknown_calls) {
    EXPECT_FALSE(check(program(), "misspelt", plain).faults.empty());
    EXPECT_FALSE(check(program(), "waiter_wake", plain).faults.empty()) << "it makes a system call";
    EXPECT_FALSE(check(program(), "event_emit", plain).faults.empty()) << "it calls its handlers";
}

/// Object code written by hand, for shapes that no compiler produces on request.
Verdict of(std::string_view lines, const std::string& format = {}) {
    Program hand;
    add_disassembly(hand, (format + "Disassembly of section .text:\n0000000000000000 <f>:\n").append(lines));
    return check(hand, "f", plain);
}

TEST(Check, accepts_a_backward_jump_that_closes_no_cycle) {
    const Verdict verdict = of(" 0:\tjmp    4 <f+0x4>\n 2:\tret\n 4:\tjmp    2 <f+0x2>\n");
    EXPECT_TRUE(verdict.faults.empty());
    EXPECT_TRUE(verdict.loops.empty());
}

TEST(Check, follows_a_counter_that_is_spilled_to_the_stack) {
    const Verdict verdict =
        of(" 0:\txor    edx,edx\n 2:\tmov    QWORD PTR [rsp-0x10],rdx\n 8:\tmov    rdx,QWORD PTR [rdi]\n"
           " c:\tmov    rdx,QWORD PTR [rsp-0x10]\n 10:\tadd    rdx,0x1\n 14:\tcmp    rdx,0x3f\n"
           " 18:\tjbe    2 <f+0x2>\n 1a:\tret\n");
    ASSERT_TRUE(verdict.faults.empty());
    ASSERT_EQ(verdict.loops.size(), 1u);
    EXPECT_EQ(verdict.loops[0].passes.value_or(0) / 2, 32u) << "sixty-four, or one more";
}

TEST(Check, merges_equal_tests_on_different_paths) {
    const Verdict verdict =
        of(" 0:\txor    eax,eax\n 2:\tadd    rax,0x1\n 4:\ttest   BYTE PTR [rdi],0x1\n 6:\tje     e <f+0xe>\n"
           " 8:\tcmp    rax,0x10\n a:\tjne    2 <f+0x2>\n c:\tret\n e:\tcmp    rax,0x10\n"
           " 10:\tjne    2 <f+0x2>\n 12:\tret\n");
    ASSERT_TRUE(verdict.faults.empty());
    EXPECT_EQ(verdict.loops.at(0).passes.value_or(0), 16u);
}

Verdict of_aarch64_code(std::string_view lines) {
    return of(lines, "f.o:     file format elf64-littleaarch64\n");
}

TEST(Aarch64, recognizes_a_counting_compare_instruction) {
    const Verdict verdict = of_aarch64_code(" 0:\tmovz\tx8, #0x28\n 4:\tldr\tx9, [x0], #8\n 8:\tsubs\tx8, "
                                            "x8, #0x1\n c:\tb.ne\t4 <f+0x4>  // b.any\n 10:\tret\n");
    ASSERT_TRUE(verdict.faults.empty());
    EXPECT_EQ(verdict.loops.at(0).passes.value_or(0), 40u);
}

TEST(Aarch64, follows_a_counter_spilled_across_a_call_and_a_register_pair) {
    const Verdict verdict = of_aarch64_code(" 0:\tstp\tx29, x30, [sp, #-32]!\n 4:\torr\tx8, xzr, xzr\n "
                                            "8:\tstp\tx0, x8, [sp, #16]\n c:\tldadd\tx9, x8, [x0]\n"
                                            " 10:\tldp\tx0, x8, [sp, #16]\n 14:\tadd\tx8, x8, #0x10\n "
                                            "18:\tsubs\txzr, x8, #0x140\n 1c:\tb.cc\t8 <f+0x8>\n"
                                            " 20:\tldp\tx29, x30, [sp], #32\n 24:\tret\n");
    ASSERT_TRUE(verdict.faults.empty());
    EXPECT_EQ(verdict.loops.at(0).passes.value_or(0) / 2, 10u);
}

struct Shape {
    std::string name;
    std::string lines;
};
void PrintTo(const Shape& shape, std::ostream* out) { *out << shape.name; }

class Aarch64Uncounted : public testing::TestWithParam<Shape> {};
TEST_P(Aarch64Uncounted, is_refused) { EXPECT_FALSE(of_aarch64_code(GetParam().lines).faults.empty()); }

// clang-format off
INSTANTIATE_TEST_SUITE_P(
    Shapes, Aarch64Uncounted,
    testing::Values(
        Shape{"exclusive_store",          " 0:\tldaxr\tx8, [x0]\n 4:\tadd\tx9, x8, #0x1\n 8:\tstlxr\tw10, x9, [x0]\n c:\tcbnz\tw10, 0 <f>\n 10:\tret\n"},
        Shape{"compare_and_swap",         " 0:\tldr\tx8, [x0]\n 4:\torr\tx9, xzr, x8\n 8:\tcasal\tx9, x1, [x0]\n c:\tsubs\txzr, x9, x8\n 10:\tb.ne\t0 <f>\n 14:\tret\n"},
        Shape{"bit_of_shared_memory",     " 0:\tldarb\tw8, [x0]\n 4:\ttbz\tw8, #0, 0 <f>\n 8:\tret\n"},
        Shape{"counter_set_by_an_atomic", " 0:\torr\tx8, xzr, xzr\n 4:\tadd\tx8, x8, #0x1\n 8:\tswpal\tx9, x8, [x0]\n c:\tsubs\txzr, x8, #0x28\n 10:\tb.cc\t4 <f+0x4>\n 14:\tret\n"},
        Shape{"flags_of_another",         " 0:\torr\tx8, xzr, xzr\n 4:\tadd\tx8, x8, #0x1\n 8:\tsubs\txzr, x8, #0x28\n c:\tccmp\tx9, #0x0, #0x4, cc\n 10:\tb.cc\t4 <f+0x4>\n 14:\tret\n"},
        Shape{"counter_lost_in_a_call",   " 0:\torr\tx8, xzr, xzr\n 4:\tbl\t20 <f+0x20>\n 8:\tadd\tx8, x8, #0x1\n c:\tsubs\txzr, x8, #0x28\n 10:\tb.cc\t4 <f+0x4>\n 14:\tret\n"},
        Shape{"base_that_is_written_back", " 0:\torr\tx8, xzr, xzr\n 4:\tldr\tx8, [x8, #8]!\n 8:\tsubs\txzr, x8, #0x28\n c:\tb.cc\t4 <f+0x4>\n 10:\tret\n"}),
    [](const auto& one) { return one.param.name; });
// clang-format on

class Uncounted : public testing::TestWithParam<Shape> {};
TEST_P(Uncounted, is_refused) { EXPECT_FALSE(of(GetParam().lines).faults.empty()); }

// clang-format off
INSTANTIATE_TEST_SUITE_P(
    Shapes, Uncounted,
    testing::Values(
        Shape{"moves_away_from_its_bound", " 0:\txor    eax,eax\n 2:\tsub    rax,0x1\n 6:\tcmp    rax,0x10\n a:\tjle    2 <f+0x2>\n c:\tret\n"},
        Shape{"steps_over_its_end",        " 0:\txor    eax,eax\n 2:\tadd    rax,0x3\n 6:\tcmp    rax,0x10\n a:\tjne    2 <f+0x2>\n c:\tret\n"},
        Shape{"bound_in_shared_memory",    " 0:\txor    eax,eax\n 2:\tadd    rax,0x1\n 6:\tcmp    rax,QWORD PTR [rdi]\n a:\tjb     2 <f+0x2>\n c:\tret\n"},
        Shape{"bound_moves_too",           " 0:\txor    eax,eax\n 2:\tadd    rax,0x1\n 4:\tadd    rsi,0x1\n 6:\tcmp    rax,rsi\n a:\tjb     2 <f+0x2>\n c:\tret\n"},
        Shape{"counter_in_shared_memory",  " 2:\tadd    QWORD PTR [rdi],0x1\n 6:\tcmp    QWORD PTR [rdi],0x10\n a:\tjb     2 <f+0x2>\n c:\tret\n"},
        Shape{"counter_lost_in_a_call",    " 0:\txor    eax,eax\n 2:\tcall   20 <f+0x20>\n 4:\tadd    rax,0x1\n 6:\tcmp    rax,0x10\n a:\tjb     2 <f+0x2>\n c:\tret\n"},
        Shape{"exit_not_on_every_pass",    " 0:\txor    eax,eax\n 2:\tadd    rax,0x1\n 4:\ttest   BYTE PTR [rdi],0x1\n 6:\tje     2 <f+0x2>\n 8:\tcmp    rax,0x10\n a:\tjb     2 <f+0x2>\n c:\tret\n"},
        Shape{"counter_kept_on_one_path",  " 0:\txor    eax,eax\n 2:\ttest   BYTE PTR [rdi],0x1\n 4:\tje     8 <f+0x8>\n 6:\tadd    rax,0x1\n 8:\tcmp    rax,0x10\n a:\tjb     2 <f+0x2>\n c:\tret\n"},
        Shape{"entered_twice",             " 0:\tje     6 <f+0x6>\n 2:\tadd    rax,0x1\n 6:\tcmp    rax,0x10\n a:\tjb     2 <f+0x2>\n c:\tret\n"},
        Shape{"two_exits_of_two_bounds",   " 0:\txor    eax,eax\n 2:\tadd    rax,0x1\n 4:\ttest   BYTE PTR [rdi],0x1\n 6:\tje     e <f+0xe>\n 8:\tcmp    rax,0x10\n a:\tjne    2 <f+0x2>\n c:\tret\n e:\tcmp    rax,0x12\n 10:\tjne    2 <f+0x2>\n 12:\tret\n"},
        Shape{"no_exit",                   " 0:\tjmp    0 <f>\n"}),
    [](const auto& one) { return one.param.name; });
// clang-format on

} // namespace
} // namespace tappet::waitfree
