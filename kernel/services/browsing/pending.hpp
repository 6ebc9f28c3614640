// Requests that wait for an answer: one table, and one rule for all of them. Each is looked at in every cycle
// of the service until it is over; a client that has waited too long is told that nothing was done, or that
// it may still happen.
#pragma once

#include "kernel/services/browsing/behaviour_order.hpp"
#include "kernel/services/browsing/why_order.hpp"
#include "kernel/services/configuration/property_saving.hpp"

#include <array>
#include <atomic>
#include <cstdint>
#include <variant>

namespace tappet {

class BrowserService;

namespace browsing {

/// Who asked, to whom the answer goes.
struct Asker {
    std::uint64_t client = 0; ///< serial
    std::uint32_t number = 0; ///< of the request
    Time since{};
};

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
    [[nodiscard]] bool is_over() const noexcept {
        return state_.load(std::memory_order_acquire) == State::over;
    }
    /// True: it has not run and will do nothing. False: it runs, has run, or was never posted.
    [[nodiscard]] bool withdraw() noexcept {
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

/// A port that is forced or released, an operation or a method that is called.
struct FacetCall {
    static constexpr std::size_t max_value_bytes = 512;

    MachineInstance* machine = nullptr;
    End end{};
    const Facet* facet = nullptr;
    void* place = nullptr; ///< of the port, or the component
    bool refused = false;  ///< the engine's: the component had stopped by then
    alignas(
        16) std::array<std::byte, max_value_bytes> value{}; ///< of a method: the result after the arguments
};

/// A command, followed to its end.
struct FollowedCommand {
    End command{};
    CommandState told = CommandState::sent;
    CommandSlot slot{};
    alignas(16) std::array<std::byte, 256> values{};
};

/// A component, or a whole activity, that is to start or to stop.
struct FollowedLife {
    std::size_t component = nowhere;
    std::size_t activity = nowhere;
    LifeTicket ticket{};
    LifeChange change{};
};

struct Pending {
    Asker asker{};
    /// True: it is over, and its client was answered. Null: the place is free.
    bool (BrowserService::*look)(Pending&) = nullptr;
    bool is_told = false; ///< its client heard that nobody answers, or nobody waits for an answer
    EngineCall call{};    ///< of what one engine does
    std::variant<std::monostate, FacetCall, BehaviourOrder, PropertyTransaction, FollowedCommand,
                 FollowedLife, PropertySaving, WhyOrder>
        work{};
};

} // namespace browsing
} // namespace tappet
