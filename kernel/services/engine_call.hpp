// A call of a service that an engine runs between two of its steps: once, or never if it is withdrawn in
// time.
#pragma once

#include "kernel/machine/instance/instance.hpp"

#include <atomic>

namespace tappet {

/// Whether an engine will serve a request: its activity runs, or a part of it may still run.
inline bool is_alive(MachineInstance& machine, std::size_t activity) noexcept {
    if (machine.engines()[activity].is_active()) return true;
    for (const EnginePart& each : machine.engines()[activity].plan().parts)
        if (each.state.load(std::memory_order_acquire) < ComponentState::stopped) return true;
    return false;
}

/// A message to an engine that runs once, or is withdrawn before. Until is_over() the caller must not touch
/// the message's data; after a withdrawal it may post again, even before the engine has reached the previous
/// message. Wait-free for both: one exchange decides whether it runs or is withdrawn.
class EngineCall {
public:
    /// Posts the call. False: that engine has no room for a user of this role. Only when is_over().
    [[nodiscard]] bool post(MachineInstance& machine, std::size_t activity, const Message& call,
                            Role role) noexcept {
        call_ = call;
        turn_ += states;
        state_.store(turn_ | posted, std::memory_order_release);
        Message message = call;
        message.run = &run;
        message.object = this;
        message.epoch = turn_;
        if (machine.requests().post(activity, message, role)) return true;
        state_.store(turn_ | over, std::memory_order_relaxed);
        return false;
    }
    [[nodiscard]] bool is_over() const noexcept TAPPET_REALTIME {
        return (state_.load(std::memory_order_acquire) & (states - 1)) == over;
    }
    /// Withdraws the call. True: it has not run and will do nothing. False: it runs, has run, or was never
    /// posted.
    [[nodiscard]] bool withdraw() noexcept TAPPET_REALTIME {
        std::uint32_t expected = turn_ | posted;
        return state_.compare_exchange_strong(expected, turn_ | over, std::memory_order_acq_rel);
    }

private:
    /// The lowest bits of the word; the bits above them are the turn, by which an engine detects a withdrawn
    /// message.
    enum State : std::uint32_t { posted, running, over, states = 4 };

    static void run(void* self, const std::byte* arguments) noexcept TAPPET_REALTIME {
        auto& call = *static_cast<EngineCall*>(self);
        const std::uint32_t turn = message_of(arguments).epoch;
        std::uint32_t expected = turn | posted;
        if (!call.state_.compare_exchange_strong(expected, turn | running, std::memory_order_acq_rel)) return;
        call.call_.run(call.call_.object, arguments);
        call.state_.store(turn | over, std::memory_order_release);
    }

    Message call_{};
    std::uint32_t turn_ = 0; ///< the caller's
    std::atomic<std::uint32_t> state_{over};
};

} // namespace tappet
