// A state machine with its names folded away: for each leaf and trigger the transitions that may be taken, in
// order. Where nothing may wait each of those has one list of programs to call. Computed by the compiler, or
// on the target into bounded memory.
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
    StateGuard guard = nullptr; ///< of a folded machine
    Duration after{};           ///< 0: at once
    ProgramSlice programs;      ///< folded: transition program, exits inside out, entries outside in
    StateIndex source = no_state;
    StateIndex to = no_state;        ///< as the row names it; no_state: internal
    StateIndex otherwise = no_state; ///< likewise, when the guard says no
    StateIndex target = no_state;    ///< the leaf that is active afterwards, in a plain machine
    TransitionIndex transition = 0;
    std::uint8_t source_level = 0;   ///< depth of `source` - 1
    std::uint8_t kept_levels = 0;    ///< states that are neither left nor entered, from the outside
    std::uint8_t otherwise_kept = 0; ///< likewise, on the way to `otherwise`
    std::uint8_t target_levels = 0;  ///< depth of `target`
    bool gives_reason = false;
    bool last = true;
};

/// What a state needs beside its arcs. Composite states have no arcs and programs of their own.
struct StatePlan {
    StateIndex parent = no_state;
    std::uint16_t depth = 0;
    std::uint16_t region = 0;       ///< that it lies in
    std::uint16_t first_region = 0; ///< of those inside
    std::uint16_t regions = 0;      ///< 0: a leaf
    ArcIndex conditions = no_arc;   ///< condition transitions and time-outs
    ArcIndex to_final = no_arc;     ///< always valid
    ProgramSlice run;               ///< folded: from the outside
    ProgramSlice handle;            ///< folded: from the outside
};

struct ResolvedSizes {
    std::size_t states = 0;
    std::size_t triggers = 0;
    std::size_t arcs = 0;
    std::size_t programs = 0;
    std::size_t regions = 0;
    // Of the memory of one execution, see StateMachineBinding.
    std::size_t history = 0;  ///< StateIndex
    std::size_t captured = 0; ///< bytes of the longest arguments that a transition takes

    [[nodiscard]] constexpr bool fits_in(const ResolvedSizes& room) const noexcept {
        return states <= room.states && triggers <= room.triggers && arcs <= room.arcs &&
               programs <= room.programs && regions <= room.regions;
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
    const StateIndex* regions = nullptr;     ///< [region]: its initial state
    const std::uint16_t* captured = nullptr; ///< [trigger]: bytes of its arguments that transitions take
    ResolvedSizes sizes{};
    StateIndex final_state = no_state;
    /// No orthogonal regions, no history: the active states are a leaf and those around it.
    bool plain = false;
    /// Plain, and every program and guard is a C++ function: nothing waits and nothing fails.
    bool folded = false;
    bool preconditions = false; ///< some state has one
    bool handles = false;       ///< some state has a handle program
};

/// Where the resolver writes. What has no room is counted and not stored.
struct ResolvedRoom {
    std::span<StatePlan> plans;
    std::span<std::string_view> triggers;
    std::span<ArcIndex> cells;
    std::span<StateArc> arcs;
    std::span<StateProgram> programs;
    std::span<StateIndex> regions;
    std::span<std::uint16_t> captured; ///< as many as triggers
};

namespace statechart {

class Resolver {
public:
    constexpr Resolver(const StateHierarchy& names, const ResolvedRoom& room) : names_{names}, room_{room} {
        look();
    }

    constexpr ResolvedSizes resolve() {
        for (std::size_t i = 0; i < names_.triggers; ++i)
            if (i < room_.triggers.size()) room_.triggers[i] = names_.trigger_name(i);
        find_captured();
        for (std::size_t r = 0; r < names_.regions; ++r)
            if (r < room_.regions.size()) room_.regions[r] = names_.region_initial[r];
        add_request(no_state, names_.initial_top, start_transition); // start_arc, then reset_arc
        add_request(names_.final_state, names_.initial_top, reset_transition);
        for (std::size_t i = 0; i < names_.states(); ++i) {
            StatePlan plan;
            const auto state = static_cast<StateIndex>(i);
            plan.parent = names_.parent[i];
            plan.depth = names_.depth[i];
            plan.region = names_.region_of[i];
            plan.first_region = names_.first_region[i];
            plan.regions = names_.region_count[i];
            if (!names_.composite[i]) resolve_leaf(state, plan);
            if (i < room_.plans.size()) room_.plans[i] = plan;
        }
        return {names_.states(), names_.triggers, arcs_, programs_, names_.regions, history_, captured_};
    }
    /// The flags of the view; its pointers are whose the room is.
    constexpr void describe(ResolvedView& view) const {
        view.final_state = names_.final_state;
        view.plain = plain_;
        view.folded = folded_;
        view.preconditions = preconditions_;
        view.handles = handles_;
    }

private:
    constexpr void look() {
        plain_ = !names_.orthogonal();
        for (const TransitionRow& row : names_.table.transitions)
            if (row.enters != EntryKind::initial) plain_ = false, history_ = names_.regions;
        folded_ = plain_;
        const auto note = [this](const ProgramRef& program) { folded_ &= program.program == no_program; };
        for (const StateRow& row : names_.table.states) {
            for (const ProgramRef* program : {&row.entry, &row.exit, &row.run, &row.handle}) note(*program);
            preconditions_ |= !row.precondition.empty();
            handles_ |= !row.handle.empty();
        }
        for (const TransitionRow& row : names_.table.transitions) {
            note(row.then);
            folded_ &= row.guard.condition == no_condition && !row.has_otherwise && row.captures == 0;
            captured_ = std::max(captured_, captured_by(row));
        }
        folded_ &= !preconditions_;
    }
    [[nodiscard]] constexpr std::size_t captured_by(const TransitionRow& row) const {
        std::size_t bytes = 0;
        for (std::size_t i = 0; i < row.captures; ++i) {
            const CaptureRow& capture = names_.table.captures[row.first_capture + i];
            bytes = std::max<std::size_t>(bytes, std::size_t{capture.from} + capture.size);
        }
        return bytes;
    }
    constexpr void find_captured() {
        for (std::uint16_t& bytes : room_.captured) bytes = 0;
        for (std::size_t t = 0; t < names_.transitions(); ++t) {
            if (names_.trigger[t] >= room_.captured.size()) continue;
            std::uint16_t& bytes = room_.captured[names_.trigger[t]];
            bytes = static_cast<std::uint16_t>(
                std::max<std::size_t>(bytes, captured_by(names_.table.transitions[t])));
        }
    }

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
        plan.handle = begin_programs();
        for (std::size_t level = 1; level <= names_.depth[leaf]; ++level)
            add(row_of(names_.ancestor(leaf, level)).handle, plan.handle);
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
        arc.source = source;
        arc.to = names_.to[t];
        arc.otherwise = names_.otherwise_to[t];
        if (arc.otherwise != no_state)
            arc.otherwise_kept = static_cast<std::uint8_t>(names_.shared_depth(source, arc.otherwise));
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
        arc.source = leaf;
        arc.to = target;
        arc.programs = begin_programs();
        finish(arc, leaf, names_.initial_leaf(target), 0);
    }

    constexpr void finish(StateArc& arc, StateIndex leaf, StateIndex target, std::size_t kept) {
        if (leaf != no_state) add_exits(leaf, kept, arc.programs);
        for (std::size_t level = kept + 1; level <= names_.depth[target]; ++level)
            add(row_of(names_.ancestor(target, level)).entry, arc.programs);
        arc.target = target;
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
        if (!folded_ || program.call == nullptr) return;
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
    std::size_t history_ = 0;
    std::size_t captured_ = 0;
    bool plain_ = false;
    bool folded_ = false;
    bool preconditions_ = false;
    bool handles_ = false;
};

constexpr ResolvedView view_of(const StateMachineTable& table, const ResolvedRoom& room,
                               const ResolvedSizes& taken, const Resolver& resolver) {
    ResolvedView view{.table = table,
                      .triggers = room.triggers.first(std::min(taken.triggers, room.triggers.size())),
                      .plans = room.plans.data(),
                      .cells = room.cells.data(),
                      .arcs = room.arcs.data(),
                      .programs = room.programs.data(),
                      .regions = room.regions.data(),
                      .captured = room.captured.data(),
                      .sizes = taken};
    resolver.describe(view);
    return view;
}

} // namespace statechart

/// Resolves a table that check() found good, and answers a view of the room. Whether it fitted into the room
/// is said by view.sizes. Bounded, without heap; not for real-time threads.
constexpr ResolvedView resolve_into(const StateMachineTable& table, const ResolvedRoom& room) {
    const StateHierarchy names{table};
    statechart::Resolver resolver{names, room};
    const ResolvedSizes taken = resolver.resolve();
    return statechart::view_of(table, room, taken, resolver);
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
    std::array<StatePlan, sizes.states> plans{};
    std::array<std::string_view, sizes.triggers> triggers{};
    std::array<ArcIndex, sizes.states * sizes.triggers> cells{};
    std::array<StateArc, sizes.arcs> arcs{};
    std::array<StateProgram, sizes.programs> programs{};
    std::array<StateIndex, sizes.regions> regions{};
    std::array<std::uint16_t, sizes.triggers> captured{};
    ResolvedView described{}; ///< without its pointers, so that the room may be copied

    constexpr ResolvedMachine() = default;
    explicit constexpr ResolvedMachine(const StateMachineTable& of) { static_cast<void>(load(of)); }

    /// Checks and resolves. Empty when the machine is there; otherwise what is wrong, and no machine is
    /// there. No execution may be using this room.
    [[nodiscard]] constexpr Sentence load(const StateMachineTable& of) {
        described = {};
        if (Sentence fault = statechart::check_limits(of); !fault.empty()) return fault;
        const StateHierarchy names{of};
        if (Sentence fault = statechart::Checker{names}.check(); !fault.empty()) return fault;
        statechart::Resolver resolver{names, {plans, triggers, cells, arcs, programs, regions, captured}};
        const ResolvedSizes taken = resolver.resolve();
        if (!taken.fits_in(sizes)) {
            const auto list = [](const ResolvedSizes& n) {
                return Sentence{n.states,    " states, ", n.triggers,
                                " events, ", n.arcs,      " transitions of leaves, "}
                    .add(n.programs)
                    .add(" program calls, ")
                    .add(n.regions)
                    .add(" regions");
            };
            return Sentence{"state machine \"", of.name, "\": it takes ", list(taken),
                            ", and there is room for "}
                .add(list(sizes))
                .add("; make the room larger or the machine smaller");
        }
        described = statechart::view_of(of, {}, taken, resolver);
        return {};
    }
    /// Without a machine, a view that no execution starts.
    [[nodiscard]] constexpr ResolvedView view() const {
        ResolvedView view = described;
        if (view.table.states.empty()) return view;
        view.triggers = std::span{triggers}.first(described.sizes.triggers);
        view.plans = plans.data();
        view.cells = cells.data();
        view.arcs = arcs.data();
        view.programs = programs.data();
        view.regions = regions.data();
        view.captured = captured.data();
        return view;
    }
};

/// The resolved form of a constant machine, in constant memory: resolved<loom_cycle>.view(). The machine is a
/// variable at namespace scope, so that symbols carry its name and nothing of its rows. A faulty machine
/// resolves to nothing: its user reports check().
template <const auto& machine>
inline constexpr ResolvedMachine<measure(machine.view())> resolved{machine.view()};

} // namespace tappet
