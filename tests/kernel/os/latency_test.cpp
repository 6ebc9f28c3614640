// The latency request: held while its owner lives, refused with a cure.
#include "kernel/os/latency.hpp"

#include "tests/kernel/os/folder.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <utility>

#include <sys/prctl.h>

namespace tappet::os {
namespace {

struct FakeRoot : test::Folder {
    std::string device = path + "/dev/cpu_dma_latency";
    FakeRoot() { std::filesystem::create_directory(path + "/dev"); }
};

TEST(CpuDmaLatency, is_held_at_zero_during_the_life_of_its_owner) {
    const FakeRoot root;
    std::ofstream{root.device} << "";
    EXPECT_FALSE(cpu_dma_latency_is_held());
    {
        auto held = hold_cpu_dma_latency(root.path);
        ASSERT_TRUE(held) << held.error().view();
        EXPECT_TRUE(cpu_dma_latency_is_held());
        const CpuDmaLatency moved{std::move(*held)};
        EXPECT_TRUE(moved.is_held());
        EXPECT_TRUE(cpu_dma_latency_is_held());
    }
    EXPECT_FALSE(cpu_dma_latency_is_held());
    std::ifstream written{root.device, std::ios::binary};
    std::int32_t value = -1;
    written.read(reinterpret_cast<char*>(&value), sizeof value);
    EXPECT_EQ(written.gcount(), 4);
    EXPECT_EQ(value, 0);
}

TEST(CpuDmaLatency, is_refused_with_a_cure_where_the_device_is_missing) {
    const FakeRoot root;
    const auto held = hold_cpu_dma_latency(root.path);
    ASSERT_FALSE(held);
    EXPECT_NE(held.error().view().find("CONFIG_PM"), std::string_view::npos) << held.error().view();
    EXPECT_FALSE(cpu_dma_latency_is_held());
}

TEST(TimerSlack, falls_to_one_nanosecond) {
    ASSERT_TRUE(minimise_timer_slack());
    EXPECT_EQ(prctl(PR_GET_TIMERSLACK), 1);
}

} // namespace
} // namespace tappet::os
