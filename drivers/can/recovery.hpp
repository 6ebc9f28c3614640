// A faulted bus restarts only at the machine's request, and only a limited number of times.
#pragma once

#include "drivers/can/device.hpp"

#include <atomic>

namespace tappet::can {

/// Shared by the activity that owns the device (fault, taken_up) and the background one that restarts it
/// (begin, end).
class Recovery {
public:
    /// Called before either of them runs.
    void reset(std::uint32_t restarts_allowed) noexcept {
        left_.store(restarts_allowed, std::memory_order_relaxed);
        phase_.store(Phase::running, std::memory_order_release);
    }

    /// Owner: reports that the bus is faulted. Returns false when it was already known.
    bool fault() noexcept TAPPET_REALTIME {
        Phase expected = Phase::running;
        return phase_.compare_exchange_strong(expected, Phase::faulted, std::memory_order_acq_rel);
    }
    /// Owner: returns true once after a successful restart.
    bool taken_up() noexcept TAPPET_REALTIME {
        Phase expected = Phase::restarted;
        return phase_.compare_exchange_strong(expected, Phase::running, std::memory_order_acq_rel);
    }
    [[nodiscard]] bool running() const noexcept TAPPET_REALTIME {
        return phase_.load(std::memory_order_acquire) == Phase::running;
    }
    /// Background: on `done` the caller must carry out the restart and call end().
    Restart begin() noexcept {
        if (phase_.load(std::memory_order_acquire) != Phase::faulted) return Restart::not_needed;
        if (left_.load(std::memory_order_relaxed) == 0) return Restart::exhausted;
        Phase expected = Phase::faulted;
        if (!phase_.compare_exchange_strong(expected, Phase::restarting, std::memory_order_acq_rel))
            return Restart::not_needed;
        left_.fetch_sub(1, std::memory_order_relaxed);
        return Restart::done;
    }
    Restart end(bool success) noexcept {
        phase_.store(success ? Phase::restarted : Phase::faulted, std::memory_order_release);
        return success ? Restart::done : Restart::failed;
    }

private:
    enum class Phase : std::uint8_t { running, faulted, restarting, restarted };
    std::atomic<Phase> phase_{Phase::running};
    std::atomic<std::uint32_t> left_{0};
};

} // namespace tappet::can
