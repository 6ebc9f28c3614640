// Native code made of a constant state machine: for each state and event the transitions are constants, so an
// event is a switch, and so is a step.
#pragma once

#include "kernel/statechart/native_step.hpp"

namespace tappet {

namespace native {

/// A cell of the resolved table in which there is something to ask.
struct Cell {
    StateIndex leaf = no_state;
    TriggerIndex trigger = 0;
    ArcIndex first = no_arc;
};

template <const auto& source, std::size_t type> struct MachineCode {
    using Transition = TransitionCode<source, type>;
    using Programs = Code<source, type>;
    using Execution = StateMachineExecution;
    using Reaction = Transition::Reaction;
    using Extent = Transition::Extent;
    using Round = Execution::Round;
    using Step = StepCode<source, type>;
    static constexpr const ResolvedView& view = Transition::view;
    static constexpr bool is_folded = Transition::is_folded;

    // ---- what is known of the table

    static constexpr std::size_t cell_count = [] {
        std::size_t count = 0;
        for (std::size_t i = 0; i < view.sizes.states * view.sizes.triggers; ++i)
            count += view.cells[i] != no_arc;
        return count;
    }();
    static constexpr std::array<Cell, cell_count> cells = [] {
        std::array<Cell, cell_count> all{};
        for (std::size_t i = 0, used = 0; i < view.sizes.states * view.sizes.triggers; ++i)
            if (view.cells[i] != no_arc)
                all[used++] = {static_cast<StateIndex>(i / view.sizes.triggers),
                               static_cast<TriggerIndex>(i % view.sizes.triggers), view.cells[i]};
        return all;
    }();
    // ---- an event

    // After an arc's programs; the trace may turn to this machine, and is the last to do so.
    [[gnu::noinline, gnu::cold]] static void tells(Execution& execution, std::int64_t statements,
                                                   StateIndex from, ArcIndex arc, Time now) noexcept
        TAPPET_REALTIME {
        execution.tell(from, view.arcs[arc].target, view.arcs[arc].transition, now);
        execution.clear(Execution::busy);
        if (execution.mode_ != Execution::ready)
            static_cast<void>(execution.finish_with(StateOutcome::taken, statements, now));
    }
    template <StateIndex leaf, ArcIndex arc>
    [[gnu::always_inline]] static Reaction takes(Execution& execution, Run& run, Time now) noexcept
        TAPPET_REALTIME {
        Transition::template gives_reason<arc>(execution, now);
        Next next = end_node;
        std::size_t part = 0;
        if (!Transition::template performs_parts<leaf, arc>(
                std::make_index_sequence<Transition::template parts<leaf, arc>.count>{}, execution, run, next,
                part)) [[unlikely]] {
            Transition::breaks_off_at(execution, run.statements, run.fresh, next, arc, part, now);
            return Reaction::handed;
        }
        Transition::template arrives<leaf, arc>(execution, now);
        if (execution.trace_ == nullptr) [[likely]]
            return Reaction::taken;
        tells(execution, run.statements, leaf, arc, now);
        return Reaction::handed;
    }

    // True when the arcs after it are not asked.
    template <StateIndex leaf, ArcIndex arc>
    [[gnu::always_inline]] static bool reacts(Execution& execution, Run& run, Time now,
                                              const std::byte* arguments, Reaction& reaction,
                                              ArcIndex& asked) noexcept TAPPET_REALTIME {
        constexpr bool has_otherwise = view.table.transitions[view.arcs[arc].transition].has_otherwise;
        if constexpr (has_otherwise) { // asked there, once
            reaction = Reaction::by_table;
            asked = arc;
        } else {
            const ConditionResult result = Transition::template may_take<arc>(execution, arguments);
            if (result == ConditionResult::yes) {
                reaction = takes<leaf, arc>(execution, run, now);
            } else if (result == ConditionResult::failed) {
                reaction = Reaction::by_table;
                asked = arc;
            }
        }
        return reaction != Reaction::on;
    }
    template <StateIndex leaf, ArcIndex first, std::size_t... i>
    [[gnu::always_inline]] static Reaction reacts(std::index_sequence<i...>, Execution& execution, Run& run,
                                                  Time now, const std::byte* arguments,
                                                  ArcIndex& asked) noexcept TAPPET_REALTIME {
        Reaction reaction = Reaction::on;
        static_cast<void>((reacts<leaf, first + i>(execution, run, now, arguments, reaction, asked) || ...));
        return reaction;
    }

    template <std::size_t number>
    static constexpr ProgramRef handle_of = view.table.states[view.arcs[cells[number].first].source].handle;
    template <std::size_t number>
    static constexpr Extent extent_of =
        Transition::extent_of(cells[number].leaf, cells[number].first, handle_of<number>);

    template <std::size_t number>
    static StateOutcome cell(Execution& execution, Time now, const std::byte* arguments) noexcept
        TAPPET_REALTIME {
        constexpr Cell at = cells[number];
        constexpr std::size_t arcs = Step::count_arcs(at.first);
        constexpr ProgramRef handle = handle_of<number>;
        constexpr const Extent& extent = extent_of<number>;
        if constexpr (view.captured[at.trigger] != 0)
            if (arguments == nullptr) return StateOutcome::ignored;
        Run run = Step::template begins<extent.calls, !extent.is_bounded()>(execution, now,
                                                                            execution.policy_.statements);
        ArcIndex asked = at.first + arcs;
        Reaction reaction = reacts<at.leaf, at.first>(std::make_index_sequence<arcs>{}, execution, run, now,
                                                      arguments, asked);
        if (reaction == Reaction::handed) [[unlikely]]
            return StateOutcome::taken;
        if constexpr (!handle.empty())
            if (reaction == Reaction::on) {
                if constexpr (is_folded)
                    handle.call(execution.context_.component);
                else
                    reaction = Reaction::by_table;
            }
        if (reaction == Reaction::by_table) [[unlikely]]
            return execution.resume_event(at.trigger, now, arguments, asked);
        const StateOutcome outcome =
            reaction == Reaction::taken ? StateOutcome::taken : StateOutcome::ignored;
        return Step::template ends<extent.calls>(execution)
                   ? outcome
                   : execution.finish_with(outcome, run.statements, now);
    }

    // The most that one cell or the first round of one leaf runs, of those that do not count.
    template <std::size_t... cell, std::size_t... leaf>
    static constexpr std::uint32_t most_of(std::index_sequence<cell...>, std::index_sequence<leaf...>) {
        std::uint32_t most = 0;
        const auto add = [&](const Extent& extent) {
            if (!is_folded && extent.is_bounded()) most = std::max(most, extent.statements);
        };
        (add(extent_of<cell>), ...);
        (add(Step::template extent_at<Step::leaves[leaf]>), ...);
        return most;
    }
    static constexpr std::uint32_t uncounted =
        most_of(std::make_index_sequence<cell_count>{}, std::make_index_sequence<Step::leaf_count>{});

    // ---- the switches

    static constexpr std::size_t page_cells = 32;
    static constexpr std::uint32_t cell_key(std::size_t number) {
        if (number >= cell_count) return static_cast<std::uint32_t>(0x10000 + number); // none has it
        return static_cast<std::uint32_t>(cells[number].leaf * view.sizes.triggers + cells[number].trigger);
    }
    static constexpr std::uint32_t leaf_key(std::size_t number) {
        return number < Step::leaf_count ? Step::leaves[number]
                                         : static_cast<std::uint32_t>(0x10000 + number);
    }

    template <std::size_t number>
    [[gnu::always_inline]] static StateOutcome reacts_in(Execution& execution, Time now,
                                                         const std::byte* arguments) noexcept
        TAPPET_REALTIME {
        if constexpr (number < cell_count)
            return cell<number>(execution, now, arguments);
        else
            return StateOutcome::ignored;
    }
    template <std::size_t number>
    [[gnu::always_inline]] static void steps_in(Execution& execution, Time now, Round round) noexcept
        TAPPET_REALTIME {
        if constexpr (number < Step::leaf_count) Step::template state<number>(execution, now, round);
    }

#define TAPPET_EIGHT(number)                                                                                 \
    TAPPET_ONE(number);                                                                                      \
    TAPPET_ONE(number + 1);                                                                                  \
    TAPPET_ONE(number + 2);                                                                                  \
    TAPPET_ONE(number + 3);                                                                                  \
    TAPPET_ONE(number + 4);                                                                                  \
    TAPPET_ONE(number + 5);                                                                                  \
    TAPPET_ONE(number + 6);                                                                                  \
    TAPPET_ONE(number + 7)

    template <std::size_t first, std::size_t end>
    [[gnu::always_inline]] static StateOutcome react_in(std::uint32_t key, Execution& execution, Time now,
                                                        const std::byte* arguments) noexcept TAPPET_REALTIME {
        constexpr std::size_t pages = (end - first + page_cells - 1) / page_cells;
        if constexpr (pages > 1) {
            constexpr std::size_t middle = first + pages / 2 * page_cells;
            return key < cell_key(middle) ? react_in<first, middle>(key, execution, now, arguments)
                                          : react_in<middle, end>(key, execution, now, arguments);
        } else {
#define TAPPET_ONE(number)                                                                                   \
    case cell_key(first + number): return reacts_in<first + number>(execution, now, arguments)
            switch (key) {
                TAPPET_EIGHT(0);
                TAPPET_EIGHT(8);
                TAPPET_EIGHT(16);
                TAPPET_EIGHT(24);
            default: return StateOutcome::ignored;
            }
#undef TAPPET_ONE
        }
    }
    template <std::size_t first, std::size_t end>
    [[gnu::always_inline]] static void step_in(std::uint32_t key, Execution& execution, Time now,
                                               Round round) noexcept TAPPET_REALTIME {
        constexpr std::size_t pages = (end - first + page_cells - 1) / page_cells;
        if constexpr (pages > 1) {
            constexpr std::size_t middle = first + pages / 2 * page_cells;
            key < leaf_key(middle) ? step_in<first, middle>(key, execution, now, round)
                                   : step_in<middle, end>(key, execution, now, round);
        } else {
#define TAPPET_ONE(number)                                                                                   \
    case leaf_key(first + number): return steps_in<first + number>(execution, now, round)
            switch (key) {
                TAPPET_EIGHT(0);
                TAPPET_EIGHT(8);
                TAPPET_EIGHT(16);
                TAPPET_EIGHT(24);
            default: return;
            }
#undef TAPPET_ONE
        }
    }
#undef TAPPET_EIGHT

    // Of an execution that is ready: nothing waits, nothing is under way.
    static StateOutcome dispatch(Execution& execution, std::size_t trigger, Time now,
                                 const std::byte* arguments) noexcept TAPPET_REALTIME {
        if (trigger >= view.sizes.triggers) [[unlikely]]
            return StateOutcome::ignored;
        return react_in<0, cell_count>(
            static_cast<std::uint32_t>(execution.status_.active * view.sizes.triggers + trigger), execution,
            now, arguments);
    }
    static bool capture(Execution& execution, TransitionIndex transition, const std::byte* arguments) noexcept
        TAPPET_REALTIME {
        return Transition::captures_of(std::make_index_sequence<Transition::capture_count>{}, transition,
                                       execution, arguments);
    }
    static void step(Execution& execution, Time now) noexcept TAPPET_REALTIME {
        step_in<0, Step::leaf_count>(execution.status_.active, execution, now,
                                     {.statements = execution.policy_.statements});
    }
};

template <const auto& source, std::size_t type>
constexpr StateMachineFast fast_of() noexcept {
    using Machine = MachineCode<source, type>;
    if constexpr (!Machine::view.plain)
        return {nullptr, nullptr, &Machine::capture};
    else
        return {&Machine::dispatch, &Machine::step, &Machine::capture, Machine::uncounted};
}

} // namespace native

/// The quick path of a constant state machine as native code, for StateMachineBinding::fast. One with
/// orthogonal regions or history is walked; its programs and conditions are native all the same. `source`: a
/// StateMachine of rows.hpp, or a ScriptUnit with the number of a type; a variable at namespace scope.
template <const auto& source, std::size_t type = 0>
inline constexpr StateMachineFast native_machine = native::fast_of<source, type>();

} // namespace tappet
