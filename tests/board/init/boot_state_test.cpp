// The state of a slot that the loader reads: byte for byte as its own tool writes it; torn files are refused.
#include "board/init/boot_state.hpp"

#include "tests/toolchain/folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

namespace tappet::init {
namespace {

const BootState new_version{"C:SLOTB:tappet.efi", 7, 20, SlotState::installed};

TEST(BootState, is_written_as_the_loaders_own_tool_does) {
    const test::Folder folder;
    const std::string file = folder / "BGENV.DAT";
    const std::string tool =
        "bg_setenv -f " + file +
        " -r 7 --kernel=C:SLOTB:tappet.efi --args= --watchdog=20 --ustate=INSTALLED >/dev/null 2>&1";
    const int ending = std::system(tool.c_str()); // NOLINT: a test's own words
    const std::string theirs = test::contents_of(file);
    ASSERT_EQ(ending, 0) << "bg_setenv is of the package efibootguard: ci/setup";
    EXPECT_TRUE(encode(new_version) == theirs) << "of " << theirs.size() << " bytes";
}

TEST(BootState, is_read_as_it_was_written) {
    const auto read = decode(encode(new_version));
    ASSERT_TRUE(read) << read.error();
    EXPECT_EQ(read->kernel, new_version.kernel);
    EXPECT_EQ(read->revision, 7u);
    EXPECT_EQ(read->watchdog_s, 20u);
    EXPECT_EQ(read->state, SlotState::installed);
}

TEST(BootState, is_refused_when_it_is_torn) {
    const std::string good = encode(new_version);
    for (const std::size_t at : {std::size_t{0}, std::size_t{1021}, std::size_t{1024}, good.size() - 1}) {
        std::string torn = good;
        torn[at] = static_cast<char>(torn[at] ^ 1);
        const auto read = decode(torn);
        ASSERT_FALSE(read) << "byte " << at;
        EXPECT_THAT(read.error(), testing::HasSubstr("torn"));
    }
    EXPECT_THAT(decode(good.substr(1)).error(), testing::HasSubstr("132103 bytes instead of 132104"));
}

} // namespace
} // namespace tappet::init
