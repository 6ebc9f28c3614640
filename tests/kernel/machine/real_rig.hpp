// A machine in its own threads in real time, on a host whose arming checks only warn.
#pragma once

#include "kernel/machine/accept.hpp"
#include "kernel/machine/worlds/real_world.hpp"
#include "kernel/os/sleep.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <string_view>

#include <fcntl.h>
#include <unistd.h>

namespace tappet {

// clang-format off
inline constexpr Board real_board{
    .name = "test", .world = "host", .memory_budget_bytes = 4 * 1024 * 1024, .highest_priority = 40,
    .only_warned = {{"realtime-kernel", "clock-source", "rt-throttling", "cpu-governor", "heap-sealed", "cpu-dma-latency", "memory-locked", "memory-lockable", "swap", "fifo-priority", "clock-resolution"}, 11}};
// clang-format on

/// Skips the test with a message where SCHED_FIFO is not granted.
struct InRealTime : testing::Test {
    void SetUp() override {
        if (os::observe_process(real_board.highest_priority).fifo_error != 0)
            GTEST_SKIP() << "SCHED_FIFO is not granted here: run as root";
    }
};

template <const auto& table, const Board& board = real_board> struct RealRig {
    os::Clock clock{os::Clock::Kind::real};
    MachineInstance instance{AtRunTime<table, board>::machine(), clock};
    RealWorld world{instance};
    os::ArmingReport report{std::span{board.only_warned.begin(), board.only_warned.end()}};

    std::optional<Armed> arm() {
        if (!instance.configure({})) return {};
        const int nowhere_to_print = open("/dev/null", O_WRONLY);
        auto armed = world.arm(report, nowhere_to_print);
        close(nowhere_to_print);
        return armed;
    }
    /// Armed and started.
    bool runs() {
        const auto armed = arm();
        return armed && world.start(*armed);
    }
    template <class C> C& the(std::string_view name) { return *instance.template find<C>(name); }
};

} // namespace tappet
