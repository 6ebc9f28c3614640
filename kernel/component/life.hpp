// The states of a component's life (thesis 3.1.3), which any thread may read, and requests to change them.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/type_tag.hpp"

#include <atomic>
#include <cstdint>
#include <string_view>

namespace tappet {

/// Written by the component's engine alone, or by the supervisor once it has given up that engine's thread.
/// Any thread may read it.
enum class ComponentState : std::uint8_t {
    inactive, ///< constructed, perhaps configured; its activity never ran
    waiting,  ///< its activity has started; an input that it needs has no valid value yet
    starting, ///< start() runs, or is about to run after those of other components of its activity
    running,  ///< it runs its steps, and messages reach it
    stopping, ///< stop() writes the safe values, and nothing else reaches it
    stopped,  ///< its outputs hold the safe values; it does nothing, and nothing reaches it any more
    failed    ///< it could not be initialised, or its thread broke a contract: it is not started again
};

constexpr std::string_view to_text(ComponentState state) noexcept {
    switch (state) {
    case ComponentState::inactive: return "inactive";
    case ComponentState::waiting: return "waiting";
    case ComponentState::starting: return "starting";
    case ComponentState::running: return "running";
    case ComponentState::stopping: return "stopping";
    case ComponentState::stopped: return "stopped";
    case ComponentState::failed: return "failed";
    }
    return "?";
}

template <>
inline constexpr auto names_of<ComponentState> = std::array<std::string_view, 7>{
    "inactive", "waiting", "starting", "running", "stopping", "stopped", "failed"};

struct ComponentType; ///< component.hpp

using AtomicComponentState = std::atomic<ComponentState>;
static_assert(AtomicComponentState::is_always_lock_free);

/// Returns whether steps and messages reach it. Real-time, any thread.
inline bool is_running(const AtomicComponentState& state) noexcept TAPPET_REALTIME {
    return state.load(std::memory_order_acquire) == ComponentState::running;
}

/// How a call reaches a component.
enum class Entry : std::uint8_t {
    at_once, ///< in the caller's thread: while it starts, runs, or waits for its turn
    queued,  ///< by a message: only while it runs
    always   ///< a const method, or properties: its own outputs are closed while it is stopped
};

/// The gate of a component: the only way in for everything but its engine, such as reactions, method calls,
/// commands, scripts, lines and requests of browsers. It checks the component's state when it runs the call;
/// nothing else has the address. Any thread; real-time.
class GatedComponent {
public:
    GatedComponent() = default;
    /// `component` must outlive it.
    explicit GatedComponent(void* component, ComponentState now = ComponentState::inactive) noexcept
        : state{now}, component_{component} {}

    /// Sets the component, before anybody enters.
    void place(void* component) noexcept { component_ = component; }

    [[nodiscard]] bool admits(Entry entry) const noexcept TAPPET_REALTIME {
        const ComponentState now = state.load(std::memory_order_acquire);
        switch (entry) {
        case Entry::at_once:
            return now == ComponentState::starting || now == ComponentState::running ||
                   waits_for_its_turn.load(std::memory_order_relaxed);
        case Entry::queued: return now == ComponentState::running;
        case Entry::always: break;
        }
        return true;
    }
    /// Runs `call(void* component)`. Returns false when the component cannot be reached; then nothing ran. A
    /// call that has begun when a stop begins ends normally.
    template <class Call>
    [[nodiscard]] bool enter(Entry entry, Call&& call) noexcept TAPPET_REALTIME {
        if (!admits(entry)) return false;
        call(component_);
        return true;
    }

    AtomicComponentState state{ComponentState::inactive}; ///< any thread may read it
    const ComponentType* type = nullptr;                  ///< from the table's row; set before anybody enters
    /// It runs by turns with others (thesis 3.1.3) and waits: it does not run, its outputs are closed, and
    /// its peers may call it.
    std::atomic<bool> waits_for_its_turn{false};
    std::atomic<std::uint32_t> dropped{0};        ///< synchronous reactions that the gate refused
    std::atomic<std::uint32_t> dropped_writes{0}; ///< writes to its outputs while it did not run

private:
    friend class Engine;
    friend class Activity;
    friend class VirtualLoop;
    void* component_ = nullptr;
};

enum class LifeChange : std::uint8_t { start, stop, restart };

/// The outcome of a request. Superseded: a later request replaced it, and counts.
enum class LifeOutcome : std::uint8_t { pending, done, refused, superseded };

/// Why a start is refused.
enum class LifeRefusal : std::uint8_t {
    none,
    input_never_written,
    input_stale,
    not_initialised,    ///< initialise() refused, or was not called since the failure
    activity_stopped,   ///< the activity that runs it does not run
    thread_lost,        ///< its thread hangs or broke a contract
    waits_for_its_turn, ///< it runs by turns with others, and one of them runs now
    left_unsafe         ///< it has stopped, but its safe values did not reach its device
};

/// The answer to a request: the refusal, and its place.
struct LifeAnswer {
    LifeOutcome outcome = LifeOutcome::pending;
    LifeRefusal refusal = LifeRefusal::none;
    std::uint8_t part = 0;   ///< the component's number in its engine
    std::uint16_t facet = 0; ///< the input's number
};

struct LifeTicket {
    std::uint32_t number = 0;
};

/// Requests to one component or activity. Any thread asks, one serves; the last request counts. Wait-free for
/// both: a ticket, one word for the wanted change and one for the answer. Real-time.
class LifeRequests {
public:
    LifeTicket ask(LifeChange change) noexcept TAPPET_REALTIME {
        const std::uint32_t number = tickets_.fetch_add(1, std::memory_order_relaxed) + 1;
        wanted_.store(std::uint64_t{number} << 32 | static_cast<std::uint64_t>(change),
                      std::memory_order_release);
        return {number};
    }
    /// Takes a request. Returns false when there is none that was not taken yet. The serving thread only.
    [[nodiscard]] bool take(LifeTicket& ticket, LifeChange& change) noexcept TAPPET_REALTIME {
        const std::uint64_t wanted = wanted_.load(std::memory_order_acquire);
        if (wanted == taken_) return false;
        taken_ = wanted;
        ticket.number = static_cast<std::uint32_t>(wanted >> 32);
        change = static_cast<LifeChange>(wanted & 3);
        return true;
    }
    /// Answers a request. The serving thread only.
    void answer(LifeTicket ticket, LifeAnswer answer) noexcept TAPPET_REALTIME {
        answered_.store(std::uint64_t{ticket.number} << 32 | std::uint64_t{answer.facet} << 16 |
                            std::uint64_t{answer.part} << 8 |
                            static_cast<std::uint64_t>(answer.refusal) << 4 |
                            static_cast<std::uint64_t>(answer.outcome),
                        std::memory_order_release);
    }
    [[nodiscard]] LifeAnswer answer_to(LifeTicket ticket) const noexcept TAPPET_REALTIME {
        const std::uint64_t wanted = wanted_.load(std::memory_order_acquire);
        const std::uint64_t answered = answered_.load(std::memory_order_acquire);
        if (answered >> 32 == ticket.number)
            return {static_cast<LifeOutcome>(answered & 0xf), static_cast<LifeRefusal>(answered >> 4 & 0xf),
                    static_cast<std::uint8_t>(answered >> 8), static_cast<std::uint16_t>(answered >> 16)};
        return {.outcome = wanted >> 32 == ticket.number ? LifeOutcome::pending : LifeOutcome::superseded};
    }

private:
    std::atomic<std::uint32_t> tickets_{0};
    std::atomic<std::uint64_t> wanted_{0};
    std::atomic<std::uint64_t> answered_{0};
    std::uint64_t taken_ = 0;
};

} // namespace tappet
