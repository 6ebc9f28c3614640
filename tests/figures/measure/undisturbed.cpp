// Asks Linux for an undisturbed processor.
#include "tests/figures/measure/undisturbed.hpp"

#include <chrono>
#include <cstdint>
#include <thread>

#include <fcntl.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

namespace tappet::figures {

Undisturbed::Undisturbed(int processor) {
    if (processor >= 0) {
        cpu_set_t set;
        CPU_ZERO(&set);
        CPU_SET(static_cast<std::size_t>(processor), &set);
        if (pthread_setaffinity_np(pthread_self(), sizeof set, &set) != 0)
            refused_ += "processor " + std::to_string(processor) + " for a thread of its own; ";
    }
    // Ends a thread that spins without end, before it blocks the host's processors.
    constexpr rlimit spins{.rlim_cur = 60'000'000, .rlim_max = RLIM_INFINITY}; // us
    if (setrlimit(RLIMIT_RTTIME, &spins) != 0) refused_ += "RLIMIT_RTTIME; ";
    sched_param parameters{};
    parameters.sched_priority = priority;
    if (pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) != 0)
        refused_ += "SCHED_FIFO (run it as root); ";
    if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0) refused_ += "mlockall; ";
    latency_ = open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC);
    const std::int32_t none = 0;
    if (latency_ < 0 || write(latency_, &none, sizeof none) != sizeof none)
        refused_ += "/dev/cpu_dma_latency; ";
}

Undisturbed::~Undisturbed() {
    if (latency_ >= 0) close(latency_);
    sched_param parameters{};
    static_cast<void>(pthread_setschedparam(pthread_self(), SCHED_OTHER, &parameters));
    cpu_set_t all;
    CPU_ZERO(&all);
    for (int i = 0; i < CPU_SETSIZE; ++i) CPU_SET(static_cast<std::size_t>(i), &all);
    static_cast<void>(pthread_setaffinity_np(pthread_self(), sizeof all, &all));
}

void rest_after(double busy_ns) {
    std::this_thread::sleep_for(std::chrono::nanoseconds{static_cast<std::int64_t>(busy_ns / 10)});
}

} // namespace tappet::figures
