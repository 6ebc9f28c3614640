// What a request does inside the machine, in the engine that owns what it touches, while its client waits for
// the answer.
#pragma once

#include "kernel/machine/instance/instance.hpp"

#include <array>
#include <atomic>
#include <cstdint>

namespace tappet::browsing {

/// Who asked, to whom the answer goes.
struct Asker {
    std::uint64_t client = 0; ///< serial
    std::uint32_t number = 0; ///< of the request
    Time since{};
};

/// A call posted to an engine. The service fills it and posts it; the engine runs it once; until is_over()
/// the service leaves it alone. Wait-free for both: one exchange decides whether it runs or was withdrawn.
struct Errand {
    static constexpr std::size_t max_value_bytes = 512;

    Asker asker{};
    bool taken = false;    ///< the service's: this place is in use
    bool given_up = false; ///< its client was told that nobody answers
    MachineInstance* machine = nullptr;
    std::size_t component = 0; ///< whose port or operation it touches
    bool refused = false;      ///< the engine's: the component had stopped by then
    const Facet* facet = nullptr;
    void* place = nullptr; ///< of the port, or the component
    void (*act)(Errand&) noexcept TAPPET_REALTIME = nullptr;
    std::size_t argument_bytes = 0;
    alignas(16) std::array<std::byte, max_value_bytes> value{};

    /// False: that engine has no room for it.
    [[nodiscard]] bool post(std::size_t activity, std::uint32_t part) noexcept {
        state_.store(State::posted, std::memory_order_relaxed);
        Message message;
        message.run = &run;
        message.object = this;
        message.id = part;
        return machine->post_request(activity, message);
    }
    [[nodiscard]] bool is_over() const noexcept {
        return state_.load(std::memory_order_acquire) == State::over;
    }
    /// True: it has not run and will do nothing. False: it runs or has run; it is over soon.
    [[nodiscard]] bool withdraw() noexcept {
        const State before = state_.exchange(State::withdrawn, std::memory_order_acq_rel);
        if (before == State::posted) return true;
        // It was too late: what the engine wrote, or is about to write, is put back.
        if (before == State::over) state_.store(State::over, std::memory_order_release);
        return false;
    }

private:
    enum class State : std::uint8_t { posted, running, withdrawn, over };

    static void run(void* self, const std::byte*) noexcept TAPPET_REALTIME {
        auto& errand = *static_cast<Errand*>(self);
        if (errand.state_.exchange(State::running, std::memory_order_acq_rel) == State::posted)
            errand.act(errand);
        errand.state_.store(State::over, std::memory_order_release);
    }

    std::atomic<State> state_{State::over};
};

} // namespace tappet::browsing
