// What a service has an engine do between two of its steps: once, or, when it is taken back in time, never.
#pragma once

#include "kernel/machine/instance/instance.hpp"

#include <atomic>

namespace tappet {

/// Whether an engine comes to what it is asked: its activity runs, or anything of it may still run.
inline bool is_alive(MachineInstance& machine, std::size_t activity) noexcept {
    if (machine.engines()[activity].is_active()) return true;
    for (const EnginePart& each : machine.engines()[activity].plan().parts)
        if (each.state.load(std::memory_order_acquire) < ComponentState::stopped) return true;
    return false;
}

/// A message to an engine that is run once, or withdrawn before. Until is_over() whoever posted it leaves
/// what it works on alone; once withdrawn it may be posted anew, whenever the engine comes to the one before.
/// Wait-free for both: one exchange decides whether it runs or was withdrawn.
class EngineCall {
public:
    /// False: that engine has no room for somebody of this role. Only when is_over().
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
    /// True: it has not run and will do nothing. False: it runs, has run, or was never posted.
    [[nodiscard]] bool withdraw() noexcept TAPPET_REALTIME {
        std::uint32_t expected = turn_ | posted;
        return state_.compare_exchange_strong(expected, turn_ | over, std::memory_order_acq_rel);
    }

private:
    /// In the lowest bits of the word; above them the turn, by which an engine knows a message that was
    /// withdrawn.
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
    std::uint32_t turn_ = 0; ///< of who posts
    std::atomic<std::uint32_t> state_{over};
};

} // namespace tappet
