// Does this and that.
#include "tests/figures/experiments/disturbance.hpp"

#include "kernel/os/sleep.hpp"
#include "tests/figures/experiments/load.hpp"

#include <fcntl.h>
#include <unistd.h>

namespace tappet::experiments {

Disturbance::~Disturbance() {
    ends_.store(true);
    thread_.join();
}

std::expected<void, Sentence> Disturbance::start() {
    plan_ = {"disturbance", 0, -1, stack_, &Disturbance::live, this};
    return thread_.start(plan_);
}

void Disturbance::disturb() noexcept {
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    while (!ends_.load(std::memory_order_relaxed)) {
        const std::uint64_t amount = random_.below(1000);
        switch (random_.below(4)) {
        case 0: turn(amount * 500); break; // up to a millisecond
        case 1: {
            const std::uint64_t from = random_.below(memory_.size() / 2);
            for (std::uint64_t i = 0; i < memory_.size() / 2; i += 8) memory_[from + i] += amount;
            break;
        }
        case 2:
            for (std::uint64_t i = 0; i < amount; ++i)
                if (write(nowhere, memory_.data(), 4096) < 0) break;
            break;
        default: os::sleep_for(Duration{static_cast<std::int64_t>(amount) * 3'000}); break;
        }
    }
    close(nowhere);
}

} // namespace tappet::experiments
