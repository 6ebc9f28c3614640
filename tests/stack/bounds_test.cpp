// The bound on made-up programs: it adds up known needs, and refuses to guess.
#include "tests/stack/bounds.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tappet::stack_bound {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// As objdump prints it, each function at an address of its own.
Image image(std::string_view code, std::set<std::string> taken = {}) {
    Image made;
    waitfree::add_disassembly(made.functions, "Disassembly of section .text:\n" + std::string{code});
    made.taken = std::move(taken);
    return made;
}

const Rules layers{
    {{"waking", {"wake"}}, {"component", {"step"}}}, {"abort"}, {}, {{"stated", 100, "by hand"}}, {}};

constexpr std::string_view calls_a_leaf = R"(
0000000000001000 <root>:
    1000:	push   rbp
    1001:	sub    rsp,0x20
    1005:	call   2000 <leaf>
    100a:	add    rsp,0x20
    100e:	pop    rbp
    100f:	ret
0000000000002000 <leaf>:
    2000:	sub    rsp,0x100
    2007:	add    rsp,0x100
    200e:	ret
)";

TEST(Bounds, add_up_frames_and_return_addresses_along_the_deepest_path) {
    const Image program = image(calls_a_leaf);
    Bounds bounds{program, layers};
    EXPECT_EQ(bounds.of("root", {}), 8u + 0x20 + 8 + 0x100);
    EXPECT_THAT(bounds.faults(), IsEmpty());
    EXPECT_EQ(bounds.path(), "    304 root\n    256 leaf\n");
}

TEST(Bounds, include_a_large_frame_whose_pages_are_touched_in_a_loop) {
    const Image program = image(R"(
0000000000001000 <root>:
    1000:	lea    r11,[rsp-0x5000]
    1008:	sub    rsp,0x1000
    100f:	or     QWORD PTR [rsp],0x0
    1014:	cmp    rsp,r11
    1017:	jne    1008 <root+0x8>
    1019:	sub    rsp,0x40
    101d:	call   2000 <leaf>
    1022:	add    rsp,0x5040
    1029:	ret
0000000000002000 <leaf>:
    2000:	mov    r11,rsp
    2003:	sub    r11,0x3000
    200a:	sub    rsp,0x1000
    2011:	mov    QWORD PTR [rsp],0x0
    2019:	cmp    rsp,r11
    201c:	jne    200a <leaf+0xa>
    201e:	add    rsp,0x3000
    2025:	ret
)");
    Bounds bounds{program, layers};
    EXPECT_EQ(bounds.of("root", {}), 0x5000u + 0x40 + 8 + 0x3000) << "as g++ writes it, and clang";
    EXPECT_THAT(bounds.faults(), IsEmpty());
}

TEST(Bounds, use_stated_frames_and_end_at_calls_that_do_not_return) {
    const Image program = image(R"(
0000000000001000 <root>:
    1000:	call   2000 <stated>
    1005:	call   3000 <abort>
    100a:	sub    rsp,0x1000
    1011:	ret
0000000000002000 <stated>:
    2000:	sub    rsp,rax
    2003:	ret
0000000000003000 <abort>:
    3000:	sub    rsp,0x5000
    3007:	ret
)");
    Bounds bounds{program, layers};
    EXPECT_EQ(bounds.of("root", {}), 8u + 100);
    EXPECT_THAT(bounds.faults(), IsEmpty()) << "what comes after the call is never reached";
}

TEST(Bounds, include_mutual_calls_from_either_end) {
    const Image program = image(R"(
0000000000001000 <root>:
    1000:	call   2000 <even>
    1005:	sub    rsp,0x4000
    100c:	call   3000 <odd>
    1011:	add    rsp,0x4000
    1018:	ret
0000000000002000 <even>:
    2000:	sub    rsp,0x10
    2004:	call   3000 <odd>
    2009:	add    rsp,0x10
    200d:	ret
0000000000003000 <odd>:
    3000:	sub    rsp,0x100
    3007:	call   2000 <even>
    300c:	add    rsp,0x100
    3013:	ret
)");
    Rules twice = layers;
    twice.recurring = {{"even", 2, "by hand"}, {"odd", 3, "by hand"}};
    Bounds bounds{program, twice};
    EXPECT_GE(bounds.of("root", {}), 0x4000u + 8 + 2 * (0x10 + 8) + 3 * (0x100 + 8))
        << "both as often as stated";
    EXPECT_THAT(bounds.faults(), IsEmpty());
}

TEST(Bounds, follow_pointers_into_lower_layers_only) {
    const Image program = image(R"(
0000000000001000 <root>:
    1000:	call   rax
    1002:	ret
0000000000002000 <step_one>:
    2000:	sub    rsp,0x40
    2004:	call   QWORD PTR [rdi]
    2006:	add    rsp,0x40
    200a:	ret
0000000000003000 <step_of_another>:
    3000:	sub    rsp,0x4000
    3007:	add    rsp,0x4000
    300e:	ret
0000000000004000 <wake>:
    4000:	push   rbx
    4001:	pop    rbx
    4002:	ret
)",
                                {"step_one", "step_of_another", "wake"});
    Bounds bounds{program, layers};
    EXPECT_EQ(bounds.of("root", {"step_one"}), 8u + 0x40 + 8 + 8);
    EXPECT_EQ(bounds.of("root", {"step_of_another"}), 8u + 0x4000);
    EXPECT_THAT(bounds.faults(), IsEmpty());
    static_cast<void>(bounds.of("root", {"step_of_nobody"}));
    EXPECT_THAT(bounds.faults(), ElementsAre("step_of_nobody: nothing of the topmost layer has that name"));
}

struct Refused {
    std::string_view name, code, fault;
    std::set<std::string> taken{};
};
void PrintTo(const Refused& each, std::ostream* out) { *out << each.name; }

class UnboundedStack : public testing::TestWithParam<Refused> {};

TEST_P(UnboundedStack, is_a_fault) {
    const Image program = image(GetParam().code, GetParam().taken);
    Bounds bounds{program, layers};
    static_cast<void>(bounds.of("root", {}));
    EXPECT_THAT(bounds.faults(), ElementsAre(HasSubstr(GetParam().fault)));
}

INSTANTIATE_TEST_SUITE_P(, UnboundedStack,
                         testing::Values(Refused{"a_frame_of_any_size", R"(
0000000000001000 <root>:
    1000:	sub    rsp,rax
    1003:	ret
)",
                                                 "root: its frame has no constant size"},
                                         Refused{"a_frame_that_grows_in_a_loop", R"(
0000000000001000 <root>:
    1000:	push   rax
    1001:	jmp    1000 <root>
)",
                                                 "root: its frame grows in a loop"},
                                         Refused{"a_recursion", R"(
0000000000001000 <root>:
    1000:	call   1000 <root>
    1005:	ret
)",
                                                 "root -> root: a recursion"},
                                         Refused{"code_that_is_not_there", R"(
0000000000001000 <root>:
    1000:	call   9000 <gone>
    1005:	ret
)",
                                                 "its code is not seen"},
                                         Refused{"a_root_that_is_not_there", R"(
0000000000001000 <another>:
    1000:	ret
)",
                                                 "root: it is not in the program"},
                                         Refused{"a_function_of_ours_in_no_layer",
                                                 R"(
0000000000001000 <root>:
    1000:	ret
0000000000002000 <_ZN6tappet6unseenEv>:
    2000:	ret
)",
                                                 "tappet::unseen(): its address is taken, and no layer says",
                                                 {"_ZN6tappet6unseenEv"}}),
                         [](const auto& each) { return std::string{each.param.name}; });

TEST(AnImage, is_empty_without_a_program) {
    EXPECT_TRUE(read_image("/nowhere").functions.empty());
    EXPECT_TRUE(read_image("/proc/version").functions.empty());
}

} // namespace
} // namespace tappet::stack_bound
