// Random work of changing kinds.
#include "tests/figures/experiments/disturbance.hpp"

#include "kernel/base/random.hpp"
#include "kernel/os/sleep.hpp"
#include "tests/figures/experiments/load.hpp"

#include <vector>

#include <fcntl.h>
#include <unistd.h>

namespace tappet::experiments {

void disturb(const std::stop_token& ends, std::uint64_t seed) {
    Random random{seed};
    std::vector<std::uint64_t> memory(1 << 18); // 2 MB
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    while (!ends.stop_requested()) {
        const std::uint64_t amount = random.below(1000);
        switch (random.below(4)) {
        case 0: turn(amount * 500); break; // up to a millisecond
        case 1: {
            const std::uint64_t from = random.below(memory.size() / 2);
            for (std::uint64_t i = 0; i < memory.size() / 2; i += 8) memory[from + i] += amount;
            break;
        }
        case 2:
            for (std::uint64_t i = 0; i < amount; ++i)
                if (write(nowhere, memory.data(), 4096) < 0) break;
            break;
        default: os::sleep_for(Duration{static_cast<std::int64_t>(amount) * 3'000}); break;
        }
    }
    close(nowhere);
}

} // namespace tappet::experiments
