// The kernel's answers: lists and numbers as it writes them, and what is not one.
#include "kernel/os/system_file.hpp"

#include <gtest/gtest.h>

namespace tappet::os {
namespace {

TEST(KernelList, has_what_its_ranges_and_numbers_name) {
    for (const int n : {0, 1, 2, 3, 6, 8, 9}) EXPECT_TRUE(list_has("0-3,6,8-9", n)) << n;
    for (const int n : {-1, 4, 5, 7, 10}) EXPECT_FALSE(list_has("0-3,6,8-9", n)) << n;
    EXPECT_TRUE(list_has("0", 0));
}

TEST(KernelList, has_nothing_when_it_is_none) {
    for (const char* text : {"", "x", "-", "0-", "1-x,5", "99999999999999999999", ",5", "0 5"})
        EXPECT_FALSE(list_has(text, 5)) << text;
}

TEST(KernelNumber, stands_after_its_key) {
    EXPECT_EQ(number_after("Name:\tx\nVmLck:\t    64 kB\n", "VmLck:", 10), 64u);
    EXPECT_EQ(number_after("CapEff:\t000001fffeffffff\n", "CapEff:", 16), 0x1fffeffffffu);
    EXPECT_EQ(number_after("VmLck:\tmany\n", "VmLck:", 10), std::nullopt);
    EXPECT_EQ(number_after("", "VmLck:", 10), std::nullopt);
    EXPECT_EQ(number_after("N: 99999999999999999999999", "N:", 10), std::nullopt);
}

TEST(SystemFile, is_read_or_says_that_it_cannot_be) {
    const SystemFile self{"", Sentence{"/proc/self/comm"}};
    EXPECT_TRUE(self.readable);
    EXPECT_FALSE(self.text().empty());
    EXPECT_FALSE(self.text().ends_with('\n'));
    EXPECT_FALSE((SystemFile{"/nowhere", Sentence{"/proc/self/comm"}}.readable));
    EXPECT_FALSE((SystemFile{"", Sentence{"/proc"}}.readable)) << "a directory";
    EXPECT_EQ((SystemFile{"", Sentence{"/proc/kallsyms"}}.length), SystemFile::capacity)
        << "a long file is cut";
}

} // namespace
} // namespace tappet::os
