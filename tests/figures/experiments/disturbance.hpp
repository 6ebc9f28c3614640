// Random load that is not real-time and no part of the machine: what else a computer does meanwhile.
#pragma once

#include "kernel/base/random.hpp"
#include "kernel/base/text.hpp"
#include "kernel/os/thread.hpp"

#include <array>
#include <atomic>
#include <expected>
#include <vector>

namespace tappet::experiments {

/// From start() to its end a thread without real-time priority calculates, goes through memory beyond the
/// caches, calls the system and sleeps, each for a random time.
class Disturbance {
public:
    explicit Disturbance(std::uint64_t seed) : random_{seed} {}
    ~Disturbance();
    Disturbance(const Disturbance&) = delete;
    Disturbance& operator=(const Disturbance&) = delete;

    std::expected<void, Sentence> start();

private:
    static void live(void* self) noexcept { static_cast<Disturbance*>(self)->disturb(); }
    void disturb() noexcept;

    Random random_;
    std::vector<std::uint64_t> memory_ = std::vector<std::uint64_t>(1 << 18); // 2 MB
    std::atomic<bool> ends_{false};
    alignas(4096) std::array<std::byte, 64 * 1024> stack_{};
    os::ThreadPlan plan_{};
    os::Thread thread_{};
};

} // namespace tappet::experiments
