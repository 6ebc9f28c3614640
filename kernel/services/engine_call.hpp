// What a service has an engine do between two of its steps: once, or, when it is taken back in time, never.
#pragma once

#include "kernel/machine/instance/instance.hpp"

#include <atomic>

namespace tappet {

/// Whether an engine comes to what it is asked: its activity runs, or anything of it has not stopped.
inline bool is_alive(MachineInstance& machine, std::size_t activity) noexcept {
    if (machine.engines()[activity].is_active()) return true;
    for (const EnginePart& each : machine.engines()[activity].plan().parts)
        if (each.state.load(std::memory_order_acquire) != ComponentState::stopped) return true;
    return false;
}

/// A message to an engine that is run once, or withdrawn before. Until is_over() whoever posted it leaves
/// what it works on alone. Wait-free for both: one exchange decides whether it runs or was withdrawn.
class EngineCall {
public:
    /// False: that engine has no room for it.
    [[nodiscard]] bool post(MachineInstance& machine, std::size_t activity, const Message& call) noexcept {
        call_ = call;
        state_.store(State::posted, std::memory_order_relaxed);
        Message message = call;
        message.run = &run;
        message.object = this;
        const bool posted = machine.requests().post(activity, message);
        if (!posted) state_.store(State::over, std::memory_order_relaxed);
        return posted;
    }
    [[nodiscard]] bool is_over() const noexcept TAPPET_REALTIME {
        return state_.load(std::memory_order_acquire) == State::over;
    }
    /// True: it has not run and will do nothing. False: it runs, has run, or was never posted.
    [[nodiscard]] bool withdraw() noexcept TAPPET_REALTIME {
        const State before = state_.exchange(State::withdrawn, std::memory_order_acq_rel);
        if (before == State::posted) return true;
        // It was too late: what the engine wrote, or is about to write, is put back.
        if (before == State::over) state_.store(State::over, std::memory_order_release);
        return false;
    }

private:
    enum class State : std::uint8_t { posted, running, withdrawn, over };

    static void run(void* self, const std::byte* arguments) noexcept TAPPET_REALTIME {
        auto& call = *static_cast<EngineCall*>(self);
        if (call.state_.exchange(State::running, std::memory_order_acq_rel) == State::posted)
            call.call_.run(call.call_.object, arguments);
        call.state_.store(State::over, std::memory_order_release);
    }

    Message call_{};
    std::atomic<State> state_{State::over};
};

} // namespace tappet
