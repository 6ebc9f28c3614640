// SPDX-License-Identifier: Apache-2.0
// A firmware in its two processes on this host, and memory that it shares with the test, a third process.
#pragma once

#include "drivers/hardware/devices.hpp"
#include "kernel/machine/table/board.hpp"
#include "kernel/os/clock.hpp"
#include "toolchain/machine/firmware.hpp"

#include <atomic>
#include <cstdlib>
#include <new>

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

namespace tappet::test {

/// Memory of the test, the machine and its guardian. The wire stands for all outputs: 1 is not safe.
struct WirePage {
    std::atomic<std::int64_t> wire{0}, safe_since{0}, asked{0};
    std::atomic<int> by_guardian{0};
    std::atomic<bool> is_gone{false}; ///< the device is gone: no write reaches it
    void be_safe() {
        if (wire.exchange(0) != 0) safe_since = to_ns(os::Clock::monotonic());
    }
};

/// Places the page where processes that are forked later have it, too.
template <class Page>
Page* shared_page() {
    return new (::mmap(nullptr, sizeof(Page), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0))
        Page;
}

/// The devices of a guardian whose machine has none.
class NoDevices : public GuardedDevices {
public:
    std::expected<void, Sentence> open(const AcceptedMachine&) override { return {}; }
    [[nodiscard]] std::span<const ProvidedDevice> provided() const noexcept override { return {}; }
    void report(os::ArmingReport&) override {}
    [[nodiscard]] WireCounters counters() const noexcept override { return {}; }
    [[nodiscard]] Bounded<int, 16> kept_by_guardian() const noexcept override { return {}; }
    std::expected<void, Sentence> prepare_safe_ending() override { return {}; }
    std::size_t write_safe_lines() noexcept override { return 0; }
    std::size_t send_safe_frames(Duration) noexcept override { return 0; }
    std::size_t write_safe_registers(Duration, const Meanwhile&) noexcept override { return 0; }
};

/// The guardian's access to the wire.
class GuardedWire final : public NoDevices {
public:
    explicit GuardedWire(WirePage& page) : page_{page} {}
    std::size_t write_safe_lines() noexcept override {
        ++page_.by_guardian;
        if (page_.is_gone) return 1;
        page_.be_safe();
        return 0;
    }

private:
    WirePage& page_;
};

// clang-format off
inline constexpr Board board_of_host{
    .name = "test", .world = "host", .memory_budget_bytes = 4 * 1024 * 1024, .heap_bytes = 256 * 1024, .highest_priority = 40,
    .only_warned = {{"realtime-kernel", "clock-source", "rt-throttling", "cpu-governor", "heap-sealed", "cpu-dma-latency", "memory-locked", "memory-lockable", "swap", "fifo-priority", "clock-resolution"}, 11}};
// clang-format on

/// Runs in a process of its own, which forks the machine and then becomes the guardian. With SHOW_FIRMWARE
/// its output is shown.
[[noreturn]] inline void be_firmware(const AcceptedMachine& machine, WirePage& page,
                                     const FirmwareHooks& hooks) {
    const int nowhere_to_print = ::open("/dev/null", O_WRONLY);
    ::dup2(nowhere_to_print, 1);
    if (::getenv("SHOW_FIRMWARE") == nullptr) ::dup2(nowhere_to_print, 2);
    static GuardedWire wire{page};
    char name[] = "firmware";
    char* words[] = {name};
    std::_Exit(run_firmware(machine, wire, 1, words, hooks));
}

} // namespace tappet::test
