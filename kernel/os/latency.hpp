// Keeps a processor from waking late: no deep sleep while the machine is armed, no slack on timers.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/text.hpp"

#include <expected>
#include <string_view>

namespace tappet::os {

/// Holds /dev/cpu_dma_latency at 0 as long as it lives: processors stay out of deep sleep states. With it,
/// waking another processor is 14 times faster. The kernel ends the request with the process, however that
/// ends.
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

/// Opens and holds the request. `root` is a prefix of /dev. The error names the cure. Not real-time.
std::expected<CpuDmaLatency, Sentence> hold_cpu_dma_latency(std::string_view root = "") noexcept;
/// Returns true while any CpuDmaLatency of this process holds it.
[[nodiscard]] bool cpu_dma_latency_is_held() noexcept TAPPET_REALTIME;

/// Reduces the timer slack of the calling thread, and of the threads it starts, from 50 us to 1 ns. Threads
/// under SCHED_FIFO have no slack anyway. Returns false when the kernel refuses.
bool minimise_timer_slack() noexcept;

} // namespace tappet::os
