// Pages of the guide, taken apart: shown code is tried exactly as shown, and code that cannot be tried is
// refused.
#include "tests/toolchain/guide/page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tappet::guide {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

const std::string begin = "```sh\ntappet new press --can   # CAN\n```\n";

Page page(const std::string& text) {
    const auto read = read_page(text, TAPPET_TEMPLATE);
    if (!read) ADD_FAILURE() << read.error();
    return read.value_or(Page{});
}
std::string fault(const std::string& text) {
    const auto read = read_page(text, TAPPET_TEMPLATE);
    return read ? "" : read.error();
}

TEST(Page, has_nothing_to_compile_when_it_changes_nothing) {
    EXPECT_THAT(page("Words.\n\n" + begin).units, IsEmpty());
    EXPECT_THAT(page(begin).commands, ElementsAre("tappet new press --can   # CAN"));
}

TEST(Page, puts_all_kept_blocks_into_one_unit) {
    const Page read = page(begin + "```cpp own.hpp\n#pragma once\n```\n<!-- cpp\nint hidden;\n-->\n"
                                   "```diff machine.hpp\n-    reactions(),\n+    reactions( ),\n```\n");
    ASSERT_THAT(read.units, SizeIs(1));
    const Project& project = read.units[0].project;
    EXPECT_EQ(project.name, "press");
    EXPECT_EQ(project.files.at("own.hpp"), "#pragma once\n");
    EXPECT_EQ(project.code, "int hidden;\n");
    EXPECT_EQ(read.units[0].refusal, "");
}

TEST(Page, undoes_a_refused_change) {
    const std::string diff = "```diff machine.hpp\n-    reactions(),\n+    none(),\n```\n";
    const Page read = page(begin + diff + "```text refused\npress: a sentence\nover two lines\n```\n");
    ASSERT_THAT(read.units, SizeIs(1)) << "the whole is as it was begun";
    EXPECT_EQ(read.units[0].refusal, "press: a sentence over two lines");
    EXPECT_THAT(read.units[0].project.files.at("machine.hpp"), HasSubstr("none(),"));
    EXPECT_THAT(page(begin + diff).units, SizeIs(1)) << "kept";
    EXPECT_THAT(page(begin + diff + "```text incomplete\npress: x\n```\n").units, SizeIs(2)) << "kept";
}

TEST(Page, edits_only_lines_that_occur_once) {
    const std::string end = "\n+    gone,\n```\n";
    EXPECT_EQ(fault(begin + "```diff machine.hpp\n     reactions(),\n" + "+    more(),\n```\n"), "");
    EXPECT_THAT(fault(begin + "```diff machine.hpp\n-    raections()," + end),
                HasSubstr("4: the lines before"));
    EXPECT_THAT(fault(begin + "```diff nowhere.hpp\n-    reactions()," + end), HasSubstr("not once"));
    EXPECT_THAT(fault(begin + "```diff bindings.hpp\n-    io);" + end), HasSubstr("not once")) << "twice";
    EXPECT_THAT(fault(begin + "```diff machine.hpp\n+    gone,\n```\n"), HasSubstr("not once")) << "no place";
}

TEST(Page, shows_only_blocks_that_are_tried) {
    EXPECT_THAT(fault("```\nint a;\n```\n"), HasSubstr("1: \"\" is no block that is tried"));
    EXPECT_THAT(fault(begin + "```text\nan error\n```\n"), HasSubstr("no block that is tried"));
    EXPECT_THAT(fault(begin + "```diff\n-a\n+b\n```\n"), HasSubstr("no block that is tried"));
    EXPECT_THAT(fault("```cpp\nint a;\n```\n"), HasSubstr("no project yet"));
    EXPECT_THAT(fault(begin + "```text refused\nx\n```\n"), HasSubstr("no block stands before it"));
    EXPECT_THAT(fault(begin + "```cpp\nint a;\n"), HasSubstr("has no end"));
}

TEST(Page, may_have_a_comment_in_one_line) { EXPECT_EQ(fault("<!-- a note -->\n" + begin), ""); }

} // namespace
} // namespace tappet::guide
