// The gate of a device's output that the table holds in some states (held_in of kernel/limits): while it is
// closed, the driver sends the safe value, whatever its component, an event or a force asks for.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace tappet {

/// Opened and closed in the activity of a state machine, asked in the driver's. Real-time.
class OutputGate {
public:
    OutputGate() = default;
    /// An order that stands for longer than `grace` while the gate is closed is counted.
    explicit OutputGate(Duration grace) noexcept : grace_{grace} {}

    /// Opens or closes it. Returns whether that is new.
    bool set_open(bool open) noexcept TAPPET_REALTIME {
        if (open_.load(std::memory_order_relaxed) == open) return false;
        open_.store(open, std::memory_order_release);
        return true;
    }
    /// Returns whether the driver may send the value that is asked for. In the driver's activity.
    bool admits(bool is_safe, Time now) noexcept TAPPET_REALTIME {
        const bool admitted = is_safe || open_.load(std::memory_order_acquire);
        const Time since = since_.load(std::memory_order_relaxed);
        if (admitted == (since == never)) return admitted;
        if (admitted && now - since > grace_) times_.fetch_add(1, std::memory_order_relaxed);
        since_.store(admitted ? never : now, std::memory_order_relaxed);
        return admitted;
    }
    /// Returns how many orders it held back for longer than its grace. Any thread.
    [[nodiscard]] std::uint64_t times(Time now) const noexcept {
        const Time since = since_.load(std::memory_order_relaxed);
        return times_.load(std::memory_order_relaxed) + (since != never && now - since > grace_ ? 1 : 0);
    }

    OutputGate* next = nullptr; ///< of the same output: all must be open

private:
    std::atomic<bool> open_{false};
    std::atomic<Time> since_{never}; ///< the order that is held back; never: none
    std::atomic<std::uint64_t> times_{0};
    Duration grace_{};
};

/// The gates of a driver's outputs; most have none. Real-time but for add().
template <std::size_t outputs> class OutputGates {
public:
    void add(std::size_t output, OutputGate& gate) noexcept {
        gate.next = first_[output];
        first_[output] = &gate;
    }
    [[nodiscard]] bool has(std::size_t output) const noexcept TAPPET_REALTIME {
        return first_[output] != nullptr;
    }
    /// Returns whether the output must have its safe value instead of the one that is asked for.
    bool hold(std::size_t output, bool is_safe, Time now) noexcept TAPPET_REALTIME {
        bool admitted = true;
        for (OutputGate* gate = first_[output]; gate != nullptr; gate = gate->next)
            admitted &= gate->admits(is_safe, now);
        return !admitted;
    }
    /// The driver stops: nothing is asked for any longer.
    void stop(Time now) noexcept TAPPET_REALTIME {
        for (std::size_t i = 0; i < outputs; ++i) static_cast<void>(hold(i, true, now));
    }

private:
    std::array<OutputGate*, outputs> first_{};
};

} // namespace tappet
