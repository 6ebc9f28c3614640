// Components that run by turns, as start-up leaves them to the switch between them.
#pragma once

#include "kernel/activity/engine.hpp"
#include "kernel/base/bounded.hpp"
#include "kernel/control/check_turns.hpp"

#include <array>
#include <atomic>

namespace tappet {

class MachineInstance;

namespace control_detail {

/// Who writes a shared input while a chain runs; null: nobody, since its reader rests too.
struct Writer {
    void* output = nullptr;
    Engine::Parts part = 0;
};

/// An input that members of the chains write by turns.
struct SharedInput {
    void* input = nullptr;
    const PortOperations* port = nullptr;
    std::uint32_t part = 0; ///< of its component
    std::uint16_t facet = 0;
    bool of_controller = false; ///< which tracks what was sent, and does so when its set points are another's
    std::array<Writer, ExclusiveRow::max_chains> writers{}; ///< of each chain
};

/// A method call that members of the chains answer by turns.
struct SharedCall {
    void* call = nullptr;
    const MethodCallOperations* operations = nullptr;
    std::array<MethodGoal, ExclusiveRow::max_chains> goals{}; ///< of each chain
};

/// An input that a member reads from another activity.
struct WatchedInput {
    void* input = nullptr;
    const PortOperations* port = nullptr;
    std::uint32_t part = 0;
};

/// What an exclusive row became. In the machine's memory; used in its level's activity alone, but for what is
/// atomic.
struct Turns {
    MachineInstance* machine = nullptr;
    std::size_t section = 0;
    std::size_t row = 0;
    Engine* engine = nullptr;
    const ExclusiveRow* rows = nullptr; ///< the row itself
    std::span<const LevelRow> levels;
    std::span<const RoleRow> processes;
    std::array<Engine::Parts, ExclusiveRow::max_chains> members{};
    Engine::Parts level = 0; ///< of the level's parts those that always run
    Bounded<SharedInput, max_links> shared{};
    Bounded<SharedCall, max_calls> calls{};
    Bounded<WatchedInput, max_watched> watched{};
    std::atomic<std::uint32_t> running{0}; ///< the chain
    std::array<std::atomic<std::uint64_t>, ExclusiveRow::max_chains>
        times{}; ///< that each was handed over to

    [[nodiscard]] std::size_t find(std::string_view chain) const noexcept TAPPET_REALTIME;
    [[nodiscard]] Engine::Parts all() const noexcept TAPPET_REALTIME;
    /// Members of that chain, and whoever is in none.
    [[nodiscard]] Engine::Parts run_in(std::size_t chain) const noexcept TAPPET_REALTIME {
        return members[chain] | ~all();
    }
    /// Inputs read what a chain's members write, and calls reach them; those of `beginning` have written
    /// nothing yet.
    void link(std::size_t chain, Engine::Parts beginning) noexcept TAPPET_REALTIME;
    [[nodiscard]] const Stops* stops_of(const Writer& writer) const noexcept TAPPET_REALTIME;
    /// Before the engine's parts start: the first chain.
    void begin() noexcept TAPPET_REALTIME;
    [[nodiscard]] LifeAnswer hand_over(std::size_t next) noexcept TAPPET_REALTIME;
    /// Controllers that run on while another one writes their set points.
    [[nodiscard]] Engine::Parts told_by_another(std::size_t now, std::size_t next) const noexcept
        TAPPET_REALTIME;
    /// Of the inputs that are linked to a chain now: the first that was not written by the start of its
    /// parts.
    [[nodiscard]] LifeAnswer find_unwritten(std::size_t chain) const noexcept TAPPET_REALTIME;
    /// A part of it stopped, or reads from another activity what is stale; nobody: none did.
    static constexpr std::uint32_t nobody = ~std::uint32_t{0};
    [[nodiscard]] std::uint32_t failed_part(Engine::Parts among) const noexcept TAPPET_REALTIME;
    void ask_stop(std::uint32_t part) noexcept TAPPET_REALTIME;
    /// Its place among the roles of all levels, and of the process components after them.
    [[nodiscard]] std::size_t role_of(std::uint32_t part) const noexcept TAPPET_REALTIME;
};

} // namespace control_detail

} // namespace tappet
