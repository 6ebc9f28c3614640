// A state machine with its names resolved: for each leaf and trigger the candidate transitions, and for each
// transition its steps, both in order. Only this file and order.hpp define that order. Computed by the
// compiler, or on the target into bounded memory.
#pragma once

#include "kernel/statechart/check.hpp"
#include "kernel/statechart/hierarchy.hpp"

#include <array>
#include <span>

namespace tappet {

/// One step of a transition.
enum class StepKind : std::uint8_t {
    act,        ///< its program
    otherwise,  ///< its else program
    leave,      ///< exits states, innermost first: each runs its exit program, then becomes inactive
    place,      ///< makes a state active
    entry,      ///< the entry program of that state
    remembered, ///< enters the states of a history: `place` and `entry` for each
    arrive,     ///< completes the transition
    depart,     ///< completes it with no state active
    handle      ///< a state's handle program; not part of a transition
};

struct TransitionStep {
    StepKind kind = StepKind::arrive;
    std::uint8_t number = 0;     ///< place: states placed before; leave: levels that are kept
    StateIndex state = no_state; ///< arrive: the last that was placed; no_state: none, or by history
};

/// Number of a step. The steps of one transition are contiguous; the last one ends it.
using StepIndex = std::uint32_t;
inline constexpr StepIndex no_step = 0xffffffff;
constexpr bool is_last(StepKind kind) noexcept TAPPET_REALTIME {
    return kind == StepKind::arrive || kind == StepKind::depart || kind == StepKind::handle;
}
/// Execution may pause at this step: any step but pure bookkeeping.
constexpr bool may_stand(StepKind kind) noexcept TAPPET_REALTIME {
    return kind != StepKind::place && kind != StepKind::arrive && kind != StepKind::depart;
}

/// Number of an arc: four that every machine has, then the transitions of the table in order.
using ArcIndex = std::uint16_t;
inline constexpr ArcIndex start_arc = 0;
inline constexpr ArcIndex reset_arc = 1;
inline constexpr ArcIndex final_arc = 2;
inline constexpr ArcIndex leaving_arc = 3;
inline constexpr ArcIndex first_arc = 4;
inline constexpr ArcIndex no_arc = 0xffff;

/// A transition.
struct StateArc {
    ConditionRef guard{};
    Duration after{}; ///< 0: immediately
    StepIndex steps = 0;
    StepIndex otherwise_steps = 0; ///< when the guard says no
    StateIndex source = no_state;
    StateIndex to = no_state;        ///< as the row names it; no_state: internal
    StateIndex otherwise = no_state; ///< the target when the guard says no
    TransitionIndex transition = 0;
    EntryKind enters = EntryKind::initial;
    std::uint8_t source_level = 0;   ///< depth of `source` - 1
    std::uint8_t kept_levels = 0;    ///< states that are neither exited nor entered, outermost first
    std::uint8_t otherwise_kept = 0; ///< the same on the way to `otherwise`
    bool captures = false;
    bool has_otherwise = false;
    bool gives_reason = false;
    bool tells_refusal = false; ///< reports the guard's reason when an event is refused
};

/// One of the arcs that are evaluated one after the other.
class AskedArc {
public:
    constexpr AskedArc() = default;
    constexpr AskedArc(ArcIndex arc, bool is_last) noexcept
        : word_{static_cast<std::uint16_t>(arc | (is_last ? last_bit : 0u))} {}
    [[nodiscard]] constexpr ArcIndex arc() const noexcept TAPPET_REALTIME {
        return static_cast<ArcIndex>(word_ & (last_bit - 1u));
    }
    [[nodiscard]] constexpr bool is_last() const noexcept TAPPET_REALTIME { return (word_ & last_bit) != 0; }

private:
    static constexpr std::uint16_t last_bit = 0x8000;
    static_assert(first_arc + max_transitions < last_bit);
    std::uint16_t word_ = last_bit;
};
/// Index of the first of such arcs.
using AskedIndex = std::uint16_t;
inline constexpr AskedIndex none_asked = 0xffff;
static_assert(max_leaf_transitions < none_asked);

/// Data of a state besides its arcs. Only leaves have arcs to evaluate, composite states have none.
struct StatePlan {
    StateIndex parent = no_state;
    std::uint16_t depth = 0;
    std::uint16_t region = 0;           ///< region that contains it
    std::uint16_t first_region = 0;     ///< first region inside it
    std::uint16_t regions = 0;          ///< 0: a leaf
    AskedIndex conditions = none_asked; ///< condition transitions and time-outs
    StepIndex handle = no_step;         ///< its handle program
};

/// Maximum size of the arguments of an event that a state machine reacts to: their bytes are counted in 16
/// bits.
inline constexpr std::size_t most_trigger_bytes = 0xffff;
static_assert(most_trigger_bytes == std::numeric_limits<std::uint16_t>::max());

struct ResolvedSizes {
    std::size_t states = 0;
    std::size_t triggers = 0;
    std::size_t arcs = 0;
    std::size_t asked = 0;
    std::size_t steps = 0;
    std::size_t regions = 0;
    // Memory of one execution, see StateMachineBinding.
    std::size_t history = 0;  ///< StateIndex
    std::size_t captured = 0; ///< bytes of the longest arguments that a transition reads

    [[nodiscard]] constexpr bool fits_in(const ResolvedSizes& room) const noexcept {
        return states <= room.states && triggers <= room.triggers && arcs <= room.arcs &&
               asked <= room.asked && steps <= room.steps && regions <= room.regions;
    }
    constexpr bool operator==(const ResolvedSizes&) const = default;
};

/// A resolved machine, as its execution reads it.
struct ResolvedView {
    StateMachineTable table{};
    std::span<const std::string_view> triggers{};
    const StatePlan* plans = nullptr;  ///< [state]
    const AskedIndex* cells = nullptr; ///< the first arc to evaluate
    const AskedArc* asked = nullptr;
    const StateArc* arcs = nullptr;
    const TransitionStep* steps = nullptr;
    const StateIndex* regions = nullptr;     ///< [region]: its initial state
    const std::uint16_t* captured = nullptr; ///< bytes of its arguments that transitions read
    ResolvedSizes sizes{};
    StateIndex final_state = no_state;
    /// No orthogonal regions, no history: only a leaf and its enclosing states are active.
    bool plain = false;
    bool preconditions = false; ///< some state has one

    /// Points to the data of a room.
    constexpr void lead_to(const auto& room) {
        triggers = std::span{room.triggers}.first(std::min(sizes.triggers, room.triggers.size()));
        plans = room.plans.data();
        cells = room.cells.data();
        asked = room.asked.data();
        arcs = room.arcs.data();
        steps = room.steps.data();
        regions = room.regions.data();
        captured = room.captured.data();
    }

    // The interface that plan_entries() needs of a tree of states.
    [[nodiscard]] constexpr std::size_t depth_of(StateIndex state) const noexcept TAPPET_REALTIME {
        return plans[state].depth;
    }
    [[nodiscard]] constexpr StateIndex parent_of(StateIndex state) const noexcept TAPPET_REALTIME {
        return plans[state].parent;
    }
    [[nodiscard]] constexpr std::size_t region_holding(StateIndex state) const noexcept TAPPET_REALTIME {
        return plans[state].region;
    }
    [[nodiscard]] constexpr std::size_t first_region_of(StateIndex state) const noexcept TAPPET_REALTIME {
        return plans[state].first_region;
    }
    [[nodiscard]] constexpr std::size_t regions_of(StateIndex state) const noexcept TAPPET_REALTIME {
        return plans[state].regions;
    }
    [[nodiscard]] constexpr StateIndex initial_of(std::size_t region) const noexcept TAPPET_REALTIME {
        return regions[region];
    }
    [[nodiscard]] constexpr StateIndex ancestor(StateIndex state, std::size_t depth) const noexcept
        TAPPET_REALTIME {
        while (state != no_state && plans[state].depth > depth) state = plans[state].parent;
        return state;
    }
    [[nodiscard]] constexpr bool is_inside(StateIndex state, StateIndex outer) const noexcept
        TAPPET_REALTIME {
        return ancestor(state, plans[outer].depth) == outer;
    }
};

/// The resolver's output. Rows without room are counted and not stored.
struct ResolvedRoom {
    std::span<StatePlan> plans;
    std::span<std::string_view> triggers;
    std::span<AskedIndex> cells;
    std::span<AskedArc> asked;
    std::span<StateArc> arcs;
    std::span<TransitionStep> steps;
    std::span<StateIndex> regions;
    std::span<std::uint16_t> captured; ///< as many as triggers
};

namespace statechart {

/// States that are entered together, each before those inside it.
using Entering = Bounded<StateIndex, max_active_states>;

/// Lists the states that are entered below the outermost `kept` states on the way to `target`, depth first,
/// regions in their order. `remembered(region, child, enters)`: the state recorded by a history, or no_state.
template <class Tree, class Remembered>
constexpr void plan_entries(const Tree& tree, Entering& into, StateIndex target, std::size_t kept,
                            const Remembered& remembered) noexcept TAPPET_REALTIME {
    Entering open;
    into.clear();
    static_cast<void>(open.push(tree.ancestor(target, kept + 1)));
    while (!open.empty() && !into.full()) {
        const StateIndex state = open[--open.used];
        static_cast<void>(into.push(state));
        const bool is_above = state != target && tree.is_inside(target, state);
        for (std::size_t r = tree.regions_of(state); r-- > 0;) {
            const std::size_t region = tree.first_region_of(state) + r;
            StateIndex child = no_state;
            if (is_above) {
                child = tree.ancestor(target, tree.depth_of(state) + 1u);
                if (tree.region_holding(child) != region) child = no_state;
            }
            if (child == no_state) child = remembered(state, region, is_above);
            static_cast<void>(open.push(child != no_state ? child : tree.initial_of(region)));
        }
    }
}

template <class Row>
constexpr void put(std::span<Row> rows, std::size_t at, const Row& row) {
    if (at < rows.size()) rows[at] = row;
}

class Resolver {
public:
    constexpr Resolver(const StateHierarchy& names, const ResolvedRoom& room) : names_{names}, room_{room} {
        look();
    }

    constexpr ResolvedSizes resolve() {
        for (std::size_t i = 0; i < names_.triggers; ++i) put(room_.triggers, i, names_.trigger_name(i));
        find_captured();
        for (std::size_t r = 0; r < names_.regions; ++r) put(room_.regions, r, names_.region_initial[r]);
        add_request(no_state, names_.initial_top, start_transition); // in the order of their numbers
        add_request(names_.final_state, names_.initial_top, reset_transition);
        add_request(no_state, names_.final_state, final_transition);
        add_request(no_state, no_state, leaving_transition);
        for (std::size_t t = 0; t < names_.transitions(); ++t) add_transition(t);
        for (std::size_t i = 0; i < names_.states(); ++i) put(room_.plans, i, plan_of(i));
        return {names_.states(), names_.triggers, arcs_, asked_, steps_, names_.regions, history_, captured_};
    }
    /// Returns the machine's properties without the pointers: those belong to the owner of the room.
    [[nodiscard]] constexpr ResolvedView describe(const ResolvedSizes& taken) const {
        return {.table = names_.table,
                .sizes = taken,
                .final_state = names_.final_state,
                .plain = plain_,
                .preconditions = preconditions_};
    }

private:
    constexpr void look() {
        plain_ = !names_.orthogonal();
        for (const TransitionRow& row : names_.table.transitions)
            if (row.enters != EntryKind::initial) plain_ = false, history_ = names_.regions;
        for (const StateRow& row : names_.table.states) preconditions_ |= !row.precondition.empty();
        for (const TransitionRow& row : names_.table.transitions)
            captured_ = std::max(captured_, captured_by(row));
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

    constexpr StatePlan plan_of(std::size_t i) {
        const auto state = static_cast<StateIndex>(i);
        StatePlan plan;
        plan.parent = names_.parent[i];
        plan.depth = names_.depth[i];
        plan.region = names_.region_of[i];
        plan.first_region = names_.first_region[i];
        plan.regions = names_.region_count[i];
        if (!names_.table.states[i].handle.empty())
            plan.handle = add_step({.kind = StepKind::handle, .state = state});
        if (!names_.composite[i]) {
            plan.conditions = add_asked(state, no_trigger);
            for (std::size_t trigger = 0; trigger < names_.triggers; ++trigger)
                put(room_.cells, i * names_.triggers + trigger,
                    add_asked(state, static_cast<TriggerIndex>(trigger)));
        }
        return plan;
    }
    // The transitions of one leaf and trigger, in the order of evaluation (UML).
    constexpr AskedIndex add_asked(StateIndex leaf, TriggerIndex trigger) {
        const std::size_t first = asked_;
        names_.for_each_out(leaf, [&](TransitionIndex t) {
            if (names_.trigger[t] != trigger) return true;
            if (asked_ > first && asked_ <= room_.asked.size())
                room_.asked[asked_ - 1] = {room_.asked[asked_ - 1].arc(), false};
            put(room_.asked, asked_++, AskedArc{static_cast<ArcIndex>(first_arc + t), true});
            return true;
        });
        return asked_ > first ? static_cast<AskedIndex>(first) : none_asked;
    }

    constexpr void add_transition(std::size_t t) {
        const TransitionRow& row = names_.table.transitions[t];
        StateArc arc;
        arc.guard = row.guard;
        arc.after = row.timed ? row.after : Duration{};
        arc.source = names_.from[t];
        arc.source_level = static_cast<std::uint8_t>(names_.depth[arc.source] - 1);
        arc.transition = static_cast<TransitionIndex>(t);
        arc.enters = row.enters;
        arc.captures = row.captures != 0;
        arc.has_otherwise = row.has_otherwise;
        arc.gives_reason = !row.because.empty();
        arc.tells_refusal = row.on_event && !row.refusal.text.empty();
        arc.to = names_.to[t];
        arc.kept_levels = kept_by(arc.source, arc.to);
        arc.steps = add_steps(row.then, StepKind::act, arc.to, arc.kept_levels, row.enters);
        if (row.has_otherwise) {
            arc.otherwise = names_.otherwise_to[t];
            arc.otherwise_kept = kept_by(arc.source, arc.otherwise);
            arc.otherwise_steps = add_steps(row.otherwise, StepKind::otherwise, arc.otherwise,
                                            arc.otherwise_kept, EntryKind::initial);
        }
        put(room_.arcs, arcs_++, arc);
    }
    [[nodiscard]] constexpr std::uint8_t kept_by(StateIndex source, StateIndex to) const {
        return static_cast<std::uint8_t>(to == no_state ? 0 : names_.shared_depth(source, to));
    }
    constexpr void add_request(StateIndex source, StateIndex to, TransitionIndex number) {
        StateArc arc;
        arc.transition = number;
        arc.source = source;
        arc.to = to;
        if (to == no_state) {
            arc.steps = add_step({.kind = StepKind::leave});
            add_step({.kind = StepKind::depart});
        } else {
            arc.steps = add_steps({}, StepKind::act, to, 0, EntryKind::initial);
        }
        put(room_.arcs, arcs_++, arc);
    }

    // Adds the steps of one transition in their order.
    constexpr StepIndex add_steps(const ProgramRef& program, StepKind kind, StateIndex to, std::size_t kept,
                                  EntryKind enters) {
        const auto first = static_cast<StepIndex>(steps_);
        TransitionStep arrival{.kind = StepKind::arrive};
        if (!program.empty()) add_step({.kind = kind});
        if (to != no_state) {
            add_step({.kind = StepKind::leave, .number = static_cast<std::uint8_t>(kept)});
            if (enters == EntryKind::initial)
                arrival.state = add_entries(to, kept);
            else
                add_step({.kind = StepKind::remembered});
        }
        add_step(arrival);
        return first;
    }
    constexpr StateIndex add_entries(StateIndex to, std::size_t kept) {
        Entering states;
        plan_entries(names_, states, to, kept,
                     [](StateIndex, std::size_t, bool) noexcept TAPPET_REALTIME { return no_state; });
        for (std::size_t i = 0; i < states.size(); ++i) {
            add_step({StepKind::place, static_cast<std::uint8_t>(i), states[i]});
            if (!names_.table.states[states[i]].entry.empty())
                add_step({.kind = StepKind::entry, .state = states[i]});
        }
        return states[states.size() - 1];
    }
    constexpr StepIndex add_step(const TransitionStep& step) {
        put(room_.steps, steps_, step);
        return static_cast<StepIndex>(steps_++);
    }

    const StateHierarchy& names_;
    ResolvedRoom room_;
    std::size_t arcs_ = 0;
    std::size_t asked_ = 0;
    std::size_t steps_ = 0;
    std::size_t history_ = 0;
    std::size_t captured_ = 0;
    bool plain_ = false;
    bool preconditions_ = false;
};

} // namespace statechart

/// Resolves a table that check() found good; returns a view of the room. view.sizes shows whether it fitted
/// into the room. Bounded, no heap; not for real-time threads.
constexpr ResolvedView resolve_into(const StateMachineTable& table, const ResolvedRoom& room) {
    const StateHierarchy names{table};
    statechart::Resolver resolver{names, room};
    ResolvedView view = resolver.describe(resolver.resolve());
    view.lead_to(room);
    return view;
}

/// Returns the sizes that a machine needs; all zero when check() finds a fault in it.
constexpr ResolvedSizes measure(const StateMachineTable& table) {
    if (!statechart::check_limits(table).empty()) return {};
    const StateHierarchy names{table};
    return statechart::Checker{names}.check().empty() ? statechart::Resolver{names, {}}.resolve()
                                                      : ResolvedSizes{};
}

/// Storage for a machine of at most these sizes: exactly measured for a constant table, or a slot for
/// machines loaded on the target. It keeps views of the table's rows, which must outlive it.
template <ResolvedSizes sizes> struct ResolvedMachine {
    std::array<StatePlan, sizes.states> plans{};
    std::array<std::string_view, sizes.triggers> triggers{};
    std::array<AskedIndex, sizes.states * sizes.triggers> cells{};
    std::array<AskedArc, sizes.asked> asked{};
    std::array<StateArc, sizes.arcs> arcs{};
    std::array<TransitionStep, sizes.steps> steps{};
    std::array<StateIndex, sizes.regions> regions{};
    std::array<std::uint16_t, sizes.triggers> captured{};
    ResolvedView described{}; ///< without its pointers, so that the room may be copied

    constexpr ResolvedMachine() = default;
    explicit constexpr ResolvedMachine(const StateMachineTable& of) { static_cast<void>(load(of)); }

    /// Checks and resolves a table. Returns empty when the machine is loaded; otherwise the fault, and no
    /// machine is loaded. No execution may use this room during the call.
    [[nodiscard]] constexpr Sentence load(const StateMachineTable& of) {
        described = {};
        if (Sentence fault = statechart::check_limits(of); !fault.empty()) return fault;
        const StateHierarchy names{of};
        if (Sentence fault = statechart::Checker{names}.check(); !fault.empty()) return fault;
        statechart::Resolver resolver{names, {plans, triggers, cells, asked, arcs, steps, regions, captured}};
        const ResolvedSizes taken = resolver.resolve();
        if (!taken.fits_in(sizes)) {
            const auto list = [](const ResolvedSizes& n) {
                return Sentence{n.states,    " states, ", n.triggers,
                                " events, ", n.asked,     " transitions of leaves, "}
                    .add(n.steps)
                    .add(" steps of transitions, ")
                    .add(n.regions)
                    .add(" regions");
            };
            return Sentence{"state machine \"", of.name, "\": it takes ", list(taken),
                            ", and there is room for "}
                .add(list(sizes))
                .add("; make the room larger or the machine smaller");
        }
        described = resolver.describe(taken);
        return {};
    }
    /// Returns the machine; when none is loaded, a view that no execution starts.
    [[nodiscard]] constexpr ResolvedView view() const {
        ResolvedView view = described;
        if (!view.table.states.empty()) view.lead_to(*this);
        return view;
    }
};

/// The resolved form of a constant machine, in constant memory: resolved<loom_cycle>.view(). The machine must
/// be a variable at namespace scope, so that symbols contain its name and not its rows. A faulty machine
/// resolves to nothing: its user reports check().
template <const auto& machine>
inline constexpr ResolvedMachine<measure(machine.view())> resolved{machine.view()};

} // namespace tappet
