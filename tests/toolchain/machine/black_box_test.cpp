// SPDX-License-Identifier: Apache-2.0
// The box keeps the newest black boxes, whatever the clock says.
#include "toolchain/machine/black_box.hpp"

#include "tests/toolchain/folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>

#include <fcntl.h>
#include <sys/stat.h>

namespace tappet {
namespace {

namespace fs = std::filesystem;

struct BlackBoxes : testing::Test {
    test::Folder folder;
    map::black_box::Record record{.magic = map::black_box::magic, .machine = {"loom"}};

    /// Writes a black box at this time of its clock, in s since 1970.
    void keep(std::time_t at) {
        const Sentence path = keep_black_box(folder.string(), record, {});
        ASSERT_FALSE(path.empty());
        const timespec times[] = {{at, 0}, {at, 0}};
        ASSERT_EQ(::utimensat(AT_FDCWD, path.data(), times, 0), 0);
    }
    std::multiset<std::uint64_t> numbers() {
        std::multiset<std::uint64_t> all;
        for (const auto& each : fs::directory_iterator{folder}) {
            map::black_box::Record read;
            std::ifstream{each.path(), std::ios::binary}.read(reinterpret_cast<char*>(&read), sizeof read);
            all.insert(read.number);
        }
        return all;
    }
};

TEST_F(BlackBoxes, are_the_newest_ones_although_the_clock_restarts_with_each_boot) {
    for (std::time_t n = 0; n < 3 * black_boxes_kept; ++n) keep(100 - n);
    std::multiset<std::uint64_t> last;
    for (std::uint64_t n = 0; n < black_boxes_kept; ++n) last.insert(3 * black_boxes_kept - n);
    EXPECT_EQ(numbers(), last);
}

TEST_F(BlackBoxes, are_removed_first_when_they_are_damaged) {
    for (int n = 0; n < black_boxes_kept; ++n) keep(0);
    std::ofstream{folder / "loom-5.blackbox"} << "torn";
    keep(0);
    EXPECT_FALSE(numbers().contains(6));
    EXPECT_TRUE(numbers().contains(1));
    EXPECT_TRUE(numbers().contains(black_boxes_kept + 1));
}

} // namespace
} // namespace tappet
