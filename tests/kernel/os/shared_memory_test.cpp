// Sharing a machine's memory (thesis 4.8, task browsing): readers see every change and can change nothing.
#include "kernel/os/shared_memory.hpp"

#include <gtest/gtest.h>

#include <array>

#include <sys/mman.h>

namespace tappet::os {
namespace {

alignas(4096) std::array<std::byte, 8 * 4096> block{};

struct SharedBlock : testing::Test {
    SharedMemory shared;

    void SetUp() override { ASSERT_TRUE(shared.lay_under(block, "tappet-test")) << "no memfd"; }
};

TEST_F(SharedBlock, shows_its_content_through_the_descriptor) {
    const auto seen = map_to_read(shared.descriptor());
    ASSERT_EQ(seen.size(), block.size());
    block[0] = std::byte{7};
    block[block.size() - 1] = std::byte{9};
    EXPECT_EQ(seen[0], std::byte{7});
    EXPECT_EQ(seen[seen.size() - 1], std::byte{9});
    unmap(seen);
}

TEST(SharedMemory, is_zero_when_created_over_old_content) {
    block[5000] = std::byte{1};
    SharedMemory shared;
    ASSERT_TRUE(shared.lay_under(block, "tappet-test"));
    for (const std::byte each : block) ASSERT_EQ(each, std::byte{0});
}

TEST_F(SharedBlock, is_read_only_through_the_descriptor) {
    const int file = shared.descriptor();
    EXPECT_EQ(mmap(nullptr, block.size(), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0), MAP_FAILED);
    EXPECT_LT(pwrite(file, "x", 1, 0), 0);
    EXPECT_NE(ftruncate(file, 0), 0);
    const auto seen = map_to_read(file);
    ASSERT_FALSE(seen.empty());
    EXPECT_NE(mprotect(const_cast<std::byte*>(seen.data()), seen.size(), PROT_READ | PROT_WRITE), 0);
    unmap(seen);
    block[1] = std::byte{3};
    EXPECT_EQ(block[1], std::byte{3}) << "the machine itself still writes";
}

TEST(SharedMemory, outlives_its_creator_while_it_is_mapped) {
    std::span<const std::byte> seen;
    {
        SharedMemory shared;
        ASSERT_TRUE(shared.lay_under(block, "tappet-test"));
        seen = map_to_read(shared.descriptor());
        block[2] = std::byte{5};
    }
    EXPECT_EQ(seen[2], std::byte{5});
    unmap(seen);
}

TEST(SharedMemory, maps_an_invalid_descriptor_to_nothing) { EXPECT_TRUE(map_to_read(-1).empty()); }

} // namespace
} // namespace tappet::os
