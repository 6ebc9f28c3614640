// What keeps a processor from waking late: no deep sleep while the machine is armed, no slack on timers.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/text.hpp"

#include <expected>
#include <string_view>

namespace tappet::os {

/// Holds /dev/cpu_dma_latency at 0 as long as it lives: processors stay out of deep sleep states. Waking
/// another one is 14 times faster with it. The kernel lets go when the process ends, however it ends.
class CpuDmaLatency {
public:
    CpuDmaLatency() = default;
    CpuDmaLatency(CpuDmaLatency&& other) noexcept;
    CpuDmaLatency& operator=(CpuDmaLatency&& other) noexcept;
    ~CpuDmaLatency();

    [[nodiscard]] bool is_held() const noexcept { return file_ >= 0; }

private:
    friend std::expected<CpuDmaLatency, Sentence> hold_cpu_dma_latency(std::string_view root) noexcept;
    explicit CpuDmaLatency(int file) noexcept;
    int file_ = -1;
};

/// `root` stands before /dev. The error names the cure. Not real-time.
std::expected<CpuDmaLatency, Sentence> hold_cpu_dma_latency(std::string_view root = "") noexcept;
/// True while any CpuDmaLatency of this process holds it.
[[nodiscard]] bool cpu_dma_latency_is_held() noexcept TAPPET_REALTIME;

/// Lets the calling thread's timers, and those of the threads it starts, fire when they are due: 1 ns instead
/// of 50 us. Threads under SCHED_FIFO have no slack anyway. False when the kernel refuses.
bool minimise_timer_slack() noexcept;

} // namespace tappet::os
