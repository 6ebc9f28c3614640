// Components that run in turns: the data that start-up prepares for their switch.
#pragma once

#include "kernel/activity/engine.hpp"
#include "kernel/base/bounded.hpp"
#include "kernel/control/check_turns.hpp"

#include <array>
#include <atomic>

namespace tappet {

class MachineInstance;

namespace control_detail {

/// The writer of a shared input while a chain runs; null: none, since its reader does not run either.
struct Writer {
    void* output = nullptr;
    Engine::Parts part = 0;
};

/// An input that members of the chains write in turns.
struct SharedInput {
    void* input = nullptr;
    const PortOperations* port = nullptr;
    std::uint32_t part = 0; ///< of its component
    std::uint16_t facet = 0;
    bool of_controller = false; ///< of a Controller that tracks the sent value, and does so while another
                                ///< writer gives its set points
    std::array<Writer, ExclusiveRow::max_chains> writers{}; ///< of each chain
};

/// A method call that members of the chains answer in turns.
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

/// Run-time data of an exclusive row. In the machine's memory; only its level's activity uses it, except for
/// atomic members.
struct Turns {
    MachineInstance* machine = nullptr;
    std::size_t section = 0;
    std::size_t row = 0;
    Engine* engine = nullptr;
    const ExclusiveRow* rows = nullptr; ///< the row itself
    std::span<const LevelRow> levels;
    std::span<const RoleRow> processes;
    std::array<Engine::Parts, ExclusiveRow::max_chains> members{};
    Engine::Parts level = 0; ///< the parts of the level that always run
    Bounded<SharedInput, max_links> shared{};
    Bounded<SharedCall, max_calls> calls{};
    Bounded<WatchedInput, max_watched> watched{};
    std::atomic<std::uint32_t> running{0};                                    ///< the chain
    std::array<std::atomic<std::uint64_t>, ExclusiveRow::max_chains> times{}; ///< hand-overs to each chain

    [[nodiscard]] std::size_t find(std::string_view chain) const noexcept TAPPET_REALTIME;
    [[nodiscard]] Engine::Parts all() const noexcept TAPPET_REALTIME;
    /// Returns the members of that chain, and the parts in no chain.
    [[nodiscard]] Engine::Parts run_in(std::size_t chain) const noexcept TAPPET_REALTIME {
        return members[chain] | ~all();
    }
    /// Links inputs to the values that a chain's members write, and calls to its members; those of
    /// `beginning` have written nothing yet.
    void link(std::size_t chain, Engine::Parts beginning) noexcept TAPPET_REALTIME;
    [[nodiscard]] const Stops* stops_of(const Writer& writer) const noexcept TAPPET_REALTIME;
    /// Selects the first chain, before the engine's parts start.
    void begin() noexcept TAPPET_REALTIME;
    [[nodiscard]] LifeAnswer hand_over(std::size_t next) noexcept TAPPET_REALTIME;
    /// Returns the Controllers that continue while another component writes their set points.
    [[nodiscard]] Engine::Parts told_by_another(std::size_t now, std::size_t next) const noexcept
        TAPPET_REALTIME;
    /// Returns the first input linked to a chain that was not written by the start of its parts.
    [[nodiscard]] LifeAnswer find_unwritten(std::size_t chain) const noexcept TAPPET_REALTIME;
    /// Returns a part that stopped, or that reads a stale value of another activity; nobody: there is none.
    static constexpr std::uint32_t nobody = ~std::uint32_t{0};
    [[nodiscard]] std::uint32_t failed_part(Engine::Parts among) const noexcept TAPPET_REALTIME;
    void ask_stop(std::uint32_t part) noexcept TAPPET_REALTIME;
    /// Returns its index among the roles of all levels, followed by the process components.
    [[nodiscard]] std::size_t role_of(std::uint32_t part) const noexcept TAPPET_REALTIME;
};

} // namespace control_detail

} // namespace tappet
