// The latency request and the timer slack, by the kernel's interfaces.
#include "kernel/os/latency.hpp"

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/prctl.h>
#include <unistd.h>

namespace tappet::os {

namespace {
constinit std::atomic<int> held{0};
}

CpuDmaLatency::CpuDmaLatency(int file) noexcept : file_{file} {
    held.fetch_add(1, std::memory_order_acq_rel);
}

CpuDmaLatency::CpuDmaLatency(CpuDmaLatency&& other) noexcept : file_{std::exchange(other.file_, -1)} {}

CpuDmaLatency& CpuDmaLatency::operator=(CpuDmaLatency&& other) noexcept {
    std::swap(file_, other.file_);
    return *this;
}

CpuDmaLatency::~CpuDmaLatency() {
    if (file_ < 0) return;
    close(file_);
    held.fetch_sub(1, std::memory_order_acq_rel);
}

std::expected<CpuDmaLatency, Sentence> hold_cpu_dma_latency(std::string_view root) noexcept {
    const Sentence path{root, "/dev/cpu_dma_latency"};
    const int file = open(path.characters, O_WRONLY | O_CLOEXEC);
    if (file < 0) {
        const int error = errno;
        return std::unexpected(Sentence{path, " cannot be opened (", std::strerror(error), "): ",
                                        error == ENOENT
                                            ? "use a kernel with CONFIG_PM (its PM QoS makes the device)"
                                            : "run as root or let this user write to it"});
    }
    const std::int32_t microseconds = 0;
    if (write(file, &microseconds, sizeof microseconds) != sizeof microseconds) {
        const int error = errno;
        close(file);
        return std::unexpected(Sentence{path, " does not take the value 0 (", std::strerror(error),
                                        "): see that the path is the kernel's device"});
    }
    return CpuDmaLatency{file};
}

bool cpu_dma_latency_is_held() noexcept TAPPET_REALTIME { return held.load(std::memory_order_acquire) > 0; }

bool minimise_timer_slack() noexcept { return prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL) == 0; }

} // namespace tappet::os
