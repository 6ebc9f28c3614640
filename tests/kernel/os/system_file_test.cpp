// The kernel's files: lists and numbers in its format, and invalid ones.
#include "kernel/os/system_file.hpp"

#include <gtest/gtest.h>

namespace tappet::os {
namespace {

TEST(KernelList, contains_the_numbers_and_ranges_that_it_names) {
    for (const int n : {0, 1, 2, 3, 6, 8, 9}) EXPECT_TRUE(list_has("0-3,6,8-9", n)) << n;
    for (const int n : {-1, 4, 5, 7, 10}) EXPECT_FALSE(list_has("0-3,6,8-9", n)) << n;
    EXPECT_TRUE(list_has("0", 0));
}

TEST(KernelList, is_empty_when_its_text_is_invalid) {
    for (const char* text : {"", "x", "-", "0-", "1-x,5", "99999999999999999999", ",5", "0 5"})
        EXPECT_FALSE(list_has(text, 5)) << text;
}

TEST(KernelNumber, is_read_after_its_key) {
    EXPECT_EQ(number_after("Name:\tx\nVmLck:\t    64 kB\n", "VmLck:", 10), 64u);
    EXPECT_EQ(number_after("CapEff:\t000001fffeffffff\n", "CapEff:", 16), 0x1fffeffffffu);
    EXPECT_EQ(number_after("VmLck:\tmany\n", "VmLck:", 10), std::nullopt);
    EXPECT_EQ(number_after("", "VmLck:", 10), std::nullopt);
    EXPECT_EQ(number_after("N: 99999999999999999999999", "N:", 10), std::nullopt);
}

TEST(SystemFile, is_read_or_reports_that_it_cannot_be_read) {
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
