// A state machine with its hierarchy folded away: for each leaf and trigger the transitions that may be
// taken, in order, and for each of those one list of programs to call. Computed by the compiler, or on the
// target into bounded memory.
#pragma once

#include "kernel/statechart/check.hpp"
#include "kernel/statechart/hierarchy.hpp"

#include <array>
#include <span>

namespace tappet {

/// A piece of the array of programs.
struct ProgramSlice {
    std::uint16_t first = 0;
    std::uint16_t count = 0;
};

/// Number of an arc. Arcs that are asked one after the other lie side by side, up to the one that is `last`.
using ArcIndex = std::uint16_t;
inline constexpr ArcIndex start_arc = 0;
inline constexpr ArcIndex reset_arc = 1;
inline constexpr ArcIndex no_arc = start_arc; ///< in a list of arcs, where no start stands

/// One way out of one leaf.
struct StateArc {
    StateGuard guard = nullptr;
    Duration after{};             ///< 0: at once
    ProgramSlice programs;        ///< transition program, exits from the inside, entries from the outside
    StateIndex target = no_state; ///< the leaf that is active afterwards
    TransitionIndex transition = 0;
    std::uint16_t first_cell = 0;   ///< of `target`
    std::uint8_t source_level = 0;  ///< whose time of entry `after` counts from
    std::uint8_t kept_levels = 0;   ///< states that are neither left nor entered, from the outside
    std::uint8_t target_levels = 0; ///< depth of `target`
    bool gives_reason = false;
    bool last = true;
};

/// What a state needs beside its arcs. Composite states have only a parent and a depth.
struct StatePlan {
    StateIndex parent = no_state;
    std::uint16_t depth = 0;
    ArcIndex conditions = no_arc; ///< condition transitions and time-outs
    ArcIndex to_final = no_arc;   ///< always valid
    ProgramSlice run;             ///< from the outside
    ProgramSlice leave;           ///< every exit, from the inside
};

struct ResolvedSizes {
    std::size_t states = 0;
    std::size_t triggers = 0;
    std::size_t arcs = 0;
    std::size_t programs = 0;

    [[nodiscard]] constexpr bool fits_in(const ResolvedSizes& room) const noexcept {
        return states <= room.states && triggers <= room.triggers && arcs <= room.arcs &&
               programs <= room.programs;
    }
    constexpr bool operator==(const ResolvedSizes&) const = default;
};

/// A resolved machine, as its execution reads it.
struct ResolvedView {
    StateMachineTable table{};
    std::span<const std::string_view> triggers{};
    const StatePlan* plans = nullptr; ///< [state]
    const ArcIndex* cells = nullptr;  ///< [state][trigger]: the first arc to ask, or no_arc
    const StateArc* arcs = nullptr;
    const StateProgram* programs = nullptr;
};

/// Where the resolver writes. What has no room is counted and not stored.
struct ResolvedRoom {
    std::span<StatePlan> plans;
    std::span<std::string_view> triggers;
    std::span<ArcIndex> cells;
    std::span<StateArc> arcs;
    std::span<StateProgram> programs;
};

namespace statechart {

class Resolver {
public:
    constexpr Resolver(const StateHierarchy& names, const ResolvedRoom& room) : names_{names}, room_{room} {}

    constexpr ResolvedSizes resolve() {
        for (std::size_t i = 0; i < names_.triggers; ++i)
            if (i < room_.triggers.size()) room_.triggers[i] = names_.trigger_name(i);
        add_request(no_state, names_.initial_top, start_transition); // start_arc, then reset_arc
        add_request(names_.final_state, names_.initial_top, reset_transition);
        for (std::size_t i = 0; i < names_.states(); ++i) {
            StatePlan plan;
            const auto state = static_cast<StateIndex>(i);
            plan.parent = names_.parent[i];
            plan.depth = names_.depth[i];
            if (!names_.composite[i]) resolve_leaf(state, plan);
            if (i < room_.plans.size()) room_.plans[i] = plan;
        }
        return {names_.states(), names_.triggers, arcs_, programs_};
    }

private:
    constexpr void resolve_leaf(StateIndex leaf, StatePlan& plan) {
        plan.conditions = add_arcs(leaf, no_trigger);
        for (std::size_t trigger = 0; trigger < names_.triggers; ++trigger) {
            const ArcIndex first = add_arcs(leaf, static_cast<TriggerIndex>(trigger));
            const std::size_t cell = leaf * names_.triggers + trigger;
            if (cell < room_.cells.size()) room_.cells[cell] = first;
        }
        plan.to_final = static_cast<ArcIndex>(arcs_);
        add_request(leaf, names_.final_state, final_transition);

        plan.run = begin_programs();
        for (std::size_t level = 1; level <= names_.depth[leaf]; ++level)
            add(row_of(names_.ancestor(leaf, level)).run, plan.run);
        plan.leave = begin_programs();
        add_exits(leaf, 0, plan.leave);
    }

    // The transitions of one leaf and trigger, in the order in which they are asked (UML).
    constexpr ArcIndex add_arcs(StateIndex leaf, TriggerIndex trigger) {
        const std::size_t first = arcs_;
        names_.for_each_out(leaf, [&](TransitionIndex t) {
            if (names_.trigger[t] != trigger) return true;
            if (arcs_ > first && arcs_ <= room_.arcs.size()) room_.arcs[arcs_ - 1].last = false;
            add_transition(leaf, names_.from[t], t);
            return true;
        });
        return arcs_ > first ? static_cast<ArcIndex>(first) : no_arc;
    }

    constexpr void add_transition(StateIndex leaf, StateIndex source, std::size_t t) {
        const TransitionRow& row = names_.table.transitions[t];
        const bool is_internal = row.to.empty();
        const StateIndex target = is_internal ? leaf : names_.initial_leaf(names_.to[t]);
        const std::size_t kept = is_internal ? names_.depth[leaf] : names_.shared_depth(source, names_.to[t]);
        StateArc arc;
        arc.guard = row.guard.call;
        arc.after = row.timed ? row.after : Duration{};
        arc.source_level = static_cast<std::uint8_t>(names_.depth[source] - 1);
        arc.transition = static_cast<TransitionIndex>(t);
        arc.gives_reason = !row.because.empty();
        arc.programs = begin_programs();
        add(row.then, arc.programs);
        finish(arc, leaf, target, kept);
    }

    constexpr void add_request(StateIndex leaf, StateIndex target, TransitionIndex number) {
        StateArc arc;
        arc.transition = number;
        arc.programs = begin_programs();
        finish(arc, leaf, names_.initial_leaf(target), 0);
    }

    constexpr void finish(StateArc& arc, StateIndex leaf, StateIndex target, std::size_t kept) {
        if (leaf != no_state) add_exits(leaf, kept, arc.programs);
        for (std::size_t level = kept + 1; level <= names_.depth[target]; ++level)
            add(row_of(names_.ancestor(target, level)).entry, arc.programs);
        arc.target = target;
        arc.first_cell = static_cast<std::uint16_t>(target * names_.triggers);
        arc.kept_levels = static_cast<std::uint8_t>(kept);
        arc.target_levels = names_.depth[target];
        if (arcs_ < room_.arcs.size()) room_.arcs[arcs_] = arc;
        ++arcs_;
    }

    constexpr void add_exits(StateIndex leaf, std::size_t kept, ProgramSlice& slice) {
        for (StateIndex state = leaf; state != no_state && names_.depth[state] > kept;
             state = names_.parent[state])
            add(row_of(state).exit, slice);
    }
    [[nodiscard]] constexpr ProgramSlice begin_programs() const {
        return {static_cast<std::uint16_t>(programs_), 0};
    }
    constexpr void add(ProgramRef program, ProgramSlice& slice) {
        if (program.call == nullptr) return;
        if (programs_ < room_.programs.size()) room_.programs[programs_] = program.call;
        ++programs_;
        ++slice.count;
    }
    [[nodiscard]] constexpr const StateRow& row_of(StateIndex state) const {
        return names_.table.states[state];
    }

    const StateHierarchy& names_;
    ResolvedRoom room_;
    std::size_t arcs_ = 0;
    std::size_t programs_ = 0;
};

} // namespace statechart

/// Resolves a table that check() found good. Returns what it takes; it is stored whole when that fits in the
/// room. Bounded, without heap; not for real-time threads.
constexpr ResolvedSizes resolve_into(const StateMachineTable& table, const ResolvedRoom& room) {
    return statechart::Resolver{StateHierarchy{table}, room}.resolve();
}

/// What a machine takes; nothing when check() finds a fault in it.
constexpr ResolvedSizes measure(const StateMachineTable& table) {
    if (!statechart::check_limits(table).empty()) return {};
    const StateHierarchy names{table};
    return statechart::Checker{names}.check().empty() ? statechart::Resolver{names, {}}.resolve()
                                                      : ResolvedSizes{};
}

/// Room for a machine of at most these sizes: exactly measured for a constant table, or a slot that machines
/// are loaded into on the target. It keeps views of the table's rows, which outlive it.
template <ResolvedSizes sizes> struct ResolvedMachine {
    StateMachineTable table{};
    std::size_t trigger_count = 0;
    std::array<StatePlan, sizes.states> plans{};
    std::array<std::string_view, sizes.triggers> triggers{};
    std::array<ArcIndex, sizes.states * sizes.triggers> cells{};
    std::array<StateArc, sizes.arcs> arcs{};
    std::array<StateProgram, sizes.programs> programs{};

    constexpr ResolvedMachine() = default;
    explicit constexpr ResolvedMachine(const StateMachineTable& of) { static_cast<void>(load(of)); }

    /// Checks and resolves. Empty when the machine is there; otherwise what is wrong, and no machine is
    /// there. No execution may be using this room.
    [[nodiscard]] constexpr Sentence load(const StateMachineTable& of) {
        table = {};
        trigger_count = 0;
        if (Sentence fault = statechart::check_limits(of); !fault.empty()) return fault;
        const StateHierarchy names{of};
        if (Sentence fault = statechart::Checker{names}.check(); !fault.empty()) return fault;
        const ResolvedSizes taken =
            statechart::Resolver{names, {plans, triggers, cells, arcs, programs}}.resolve();
        if (!taken.fits_in(sizes)) {
            const auto list = [](const ResolvedSizes& n) {
                return Sentence{n.states,    " states, ", n.triggers,
                                " events, ", n.arcs,      " transitions of leaves, "}
                    .add(n.programs)
                    .add(" program calls");
            };
            return Sentence{"state machine \"", of.name, "\": it takes ", list(taken),
                            ", and there is room for "}
                .add(list(sizes))
                .add("; make the room larger or the machine smaller");
        }
        table = of;
        trigger_count = taken.triggers;
        return {};
    }
    /// Without a machine, a view that no execution starts.
    [[nodiscard]] constexpr ResolvedView view() const {
        if (table.states.empty()) return {};
        return {table,        std::span{triggers}.first(trigger_count),
                plans.data(), cells.data(),
                arcs.data(),  programs.data()};
    }
};

/// The resolved form of a constant machine, in constant memory: resolved<loom_cycle>.view(). The machine is a
/// variable at namespace scope, so that symbols carry its name and nothing of its rows. A faulty machine
/// resolves to nothing: its user reports check().
template <const auto& machine>
inline constexpr ResolvedMachine<measure(machine.view())> resolved{machine.view()};

} // namespace tappet
