// Native code of one transition of a constant state machine: its guards, its programs and what is left and
// entered are constants. Whatever waits or fails goes on in the walk of the execution, from where it stands.
#pragma once

#include "kernel/program/native.hpp"
#include "kernel/statechart/execution.hpp"
#include "kernel/statechart/rows.hpp"

namespace tappet {

/// Where native code finds a state machine: see tables_of() in kernel/program/native.hpp.
template <std::size_t S, std::size_t T>
constexpr StateMachineTable machine_of(const StateMachine<S, T>& machine, std::size_t) noexcept {
    return machine.view();
}
inline constexpr ProgramTables no_programs{};
template <std::size_t S, std::size_t T>
constexpr const ProgramTables& tables_of(const StateMachine<S, T>&, std::size_t) noexcept {
    return no_programs;
}

namespace native {

template <const auto& source, std::size_t type>
inline constexpr ResolvedMachine<measure(machine_of(source, type))> resolved_type{machine_of(source, type)};

/// The programs of one transition out of one leaf, in their order.
struct Parts {
    std::array<ProgramRef, 2 * max_state_depth + 1> list{};
    std::size_t count = 0;

    constexpr void add(const ProgramRef& program) {
        if (!program.empty()) list[count++] = program;
    }
};

template <const auto& source, std::size_t type> struct TransitionCode {
    using Programs = Code<source, type>;
    using Execution = StateMachineExecution;
    static constexpr ResolvedView view = resolved_type<source, type>.view();
    static constexpr bool is_folded = view.folded;

    // ---- what is known of the table

    static constexpr StateIndex ancestor(StateIndex state, std::size_t depth) {
        while (view.plans[state].depth > depth) state = view.plans[state].parent;
        return state;
    }
    static constexpr Parts parts_of(StateIndex leaf, const StateArc& arc) {
        Parts parts;
        parts.add(view.table.transitions[arc.transition].then);
        for (StateIndex s = leaf; s != no_state && view.plans[s].depth > arc.kept_levels;
             s = view.plans[s].parent)
            parts.add(view.table.states[s].exit);
        for (std::size_t level = arc.kept_levels + 1u; level <= arc.target_levels; ++level)
            parts.add(view.table.states[ancestor(arc.target, level)].entry);
        return parts;
    }
    template <StateIndex leaf, ArcIndex arc>
    static constexpr Parts parts = parts_of(leaf, view.arcs[arc]);

    // ---- one question, one program

    template <StateGuard guard, ConditionIndex condition>
    [[gnu::always_inline]] static ConditionResult ask(Execution& execution,
                                                      [[maybe_unused]] std::byte* scratch) noexcept
        TAPPET_REALTIME {
        if constexpr (guard != nullptr) {
            return guard(execution.context_.component) ? ConditionResult::yes : ConditionResult::no;
        } else if constexpr (condition != no_condition) {
            return Programs::template condition<condition>(execution.context_, execution.context_.data,
                                                           scratch);
        } else {
            return ConditionResult::yes;
        }
    }

    // The preconditions of what an arc enters, from the outside.
    template <ArcIndex arc, std::size_t level>
    [[gnu::always_inline]] static ConditionResult may_enter(Execution& execution, std::byte* scratch) noexcept
        TAPPET_REALTIME {
        constexpr StateArc row = view.arcs[arc];
        if constexpr (level > row.target_levels || !view.preconditions) {
            return ConditionResult::yes;
        } else {
            constexpr ConditionRef condition = view.table.states[ancestor(row.target, level)].precondition;
            const ConditionResult result = ask<condition.call, condition.condition>(execution, scratch);
            return result == ConditionResult::yes ? may_enter<arc, level + 1>(execution, scratch) : result;
        }
    }

    template <std::size_t number>
    [[gnu::always_inline]] static bool takes_argument(Execution& execution, const std::byte* arguments,
                                                      std::byte* scratch) noexcept TAPPET_REALTIME {
        constexpr CaptureRow row = view.table.captures[number];
        std::memcpy(Programs::template write<row.raw>(execution.context_.data, scratch), arguments + row.from,
                    row.size);
        return Programs::template instructions<row.first>(std::make_index_sequence<row.count>{},
                                                          execution.context_, execution.context_.data,
                                                          scratch) == ActionResult::done;
    }
    template <std::size_t first, std::size_t... i>
    [[gnu::always_inline]] static bool captures(std::index_sequence<i...>, Execution& execution,
                                                [[maybe_unused]] const std::byte* arguments,
                                                [[maybe_unused]] std::byte* scratch) noexcept
        TAPPET_REALTIME {
        return (takes_argument<first + i>(execution, arguments, scratch) && ...);
    }

    template <ArcIndex arc>
    [[gnu::always_inline]] static ConditionResult
    may_take(Execution& execution, [[maybe_unused]] const std::byte* arguments) noexcept TAPPET_REALTIME {
        constexpr StateArc row = view.arcs[arc];
        constexpr TransitionRow transition = view.table.transitions[row.transition];
        alignas(data_alignment) std::byte scratch[Programs::scratch_bytes];
        if constexpr (transition.captures != 0)
            if (!captures<transition.first_capture>(std::make_index_sequence<transition.captures>{},
                                                    execution, arguments, scratch)) [[unlikely]]
                return ConditionResult::failed;
        const ConditionResult result =
            ask<transition.guard.call, transition.guard.condition>(execution, scratch);
        return result == ConditionResult::yes ? may_enter<arc, row.kept_levels + 1u>(execution, scratch)
                                              : result;
    }

    /// How far a call came.
    enum class Way : std::uint8_t {
        on,       ///< nothing of it was taken
        taken,    ///< and done with
        by_table, ///< the walk asks what was asked last, and all behind it
        handed    ///< the walk has gone on from where it stood, and has ended the call
    };

    template <StateProgram call, ProgramIndex number> static constexpr bool is_private = [] {
        if constexpr (call != nullptr)
            return false;
        else if constexpr (number != no_program)
            return Programs::template is_private<number>;
        else
            return true;
    }();

    // One program; `on`: it has ended. Otherwise `why` says how it stands.
    template <StateProgram call, ProgramIndex number>
    [[gnu::always_inline]] static bool performs(Execution& execution, Run& run, ProgramReturn& why) noexcept
        TAPPET_REALTIME {
        why = ProgramReturn::ended;
        if constexpr (call != nullptr) {
            if constexpr (!is_folded)
                if (--run.statements < 0) [[unlikely]] {
                    run.statements = 0;
                    why = ProgramReturn::left_over;
                    return false;
                }
            call(execution.context_.component);
        } else if constexpr (number != no_program) {
            const bool none_left = run.statements == 0;
            const Next next = Programs::template program<number>(execution.context_, run);
            if (next >= halted) [[unlikely]] {
                why = Programs::halts(execution.context_, run, next);
                if (none_left) execution.context_.position.node = no_node; // it has not begun
                return false;
            }
        }
        if constexpr (!is_folded && !is_private<call, number>) return !execution.is(Execution::error);
        return true;
    }

    // ---- one transition

    template <StateIndex leaf, ArcIndex arc, std::size_t part>
    [[gnu::always_inline]] static bool performs_part(Execution& execution, Run& run, Time now) noexcept
        TAPPET_REALTIME {
        constexpr ProgramRef program = parts<leaf, arc>.list[part];
        ProgramReturn why{};
        if (performs<program.call, program.program>(execution, run, why)) [[likely]]
            return true;
        execution.statements_ = static_cast<std::uint32_t>(run.statements);
        execution.resume_transition(arc, part, why, now);
        return false;
    }
    template <StateIndex leaf, ArcIndex arc, std::size_t... part>
    [[gnu::always_inline]] static bool performs_parts(std::index_sequence<part...>, Execution& execution,
                                                      [[maybe_unused]] Run& run,
                                                      [[maybe_unused]] Time now) noexcept TAPPET_REALTIME {
        static_cast<void>(execution);
        return (performs_part<leaf, arc, part>(execution, run, now) && ...);
    }
    template <StateIndex leaf, ArcIndex arc, std::size_t... level>
    [[gnu::always_inline]] static void enters(std::index_sequence<level...>, Execution& execution,
                                              Time now) noexcept TAPPET_REALTIME {
        constexpr StateArc row = view.arcs[arc];
        auto& states = execution.status_.states;
        [[maybe_unused]] const auto enter = [&](std::size_t at, StateIndex state) noexcept TAPPET_REALTIME {
            states[at].state = state;
            states[at].run = RunPhase::fresh;
            states[at].entered_at = now;
        };
        (enter(row.kept_levels + level, ancestor(row.target, row.kept_levels + level + 1)), ...);
        states.used = row.target_levels;
    }

    // `taken` or `handed`.
    template <StateIndex leaf, ArcIndex arc>
    [[gnu::always_inline]] static Way takes(Execution& execution, Run& run, Time now) noexcept
        TAPPET_REALTIME {
        constexpr StateArc row = view.arcs[arc];
        if constexpr (row.gives_reason)
            execution.give_reason(row.transition, view.table.transitions[row.transition].because, now);
        if (!performs_parts<leaf, arc>(std::make_index_sequence<parts<leaf, arc>.count>{}, execution, run,
                                       now)) [[unlikely]]
            return Way::handed;
        enters<leaf, arc>(std::make_index_sequence<std::size_t{row.target_levels} - row.kept_levels>{},
                          execution, now);
        StateMachineStatus& status = execution.status_;
        status.active = row.target;
        status.last_transition = row.transition;
        execution.first_cell_ = row.first_cell;
        ++status.transitions;
        if (execution.trace_ != nullptr)
            execution.trace_(execution.trace_context_, leaf, row.target, row.transition, now);
        return Way::taken;
    }

    // ---- arguments of an event that is taken by the walk

    static constexpr std::size_t capture_count = [] {
        std::size_t count = 0;
        for (const TransitionRow& row : view.table.transitions) count += row.captures != 0;
        return count;
    }();
    static constexpr std::array<TransitionIndex, capture_count> capturing = [] {
        std::array<TransitionIndex, capture_count> all{};
        for (std::size_t i = 0, used = 0; i < view.table.transitions.size(); ++i)
            if (view.table.transitions[i].captures != 0) all[used++] = static_cast<TransitionIndex>(i);
        return all;
    }();
    template <std::size_t number>
    [[gnu::always_inline]] static bool captures_of(TransitionIndex transition, Execution& execution,
                                                   const std::byte* arguments, bool& good) noexcept
        TAPPET_REALTIME {
        if (transition != capturing[number]) return false;
        constexpr TransitionRow row = view.table.transitions[capturing[number]];
        alignas(data_alignment) std::byte scratch[Programs::scratch_bytes];
        good = captures<row.first_capture>(std::make_index_sequence<row.captures>{}, execution, arguments,
                                           scratch);
        return true;
    }
    template <std::size_t... number>
    [[gnu::always_inline]] static bool
    captures_of(std::index_sequence<number...>, [[maybe_unused]] TransitionIndex transition,
                [[maybe_unused]] Execution& execution, [[maybe_unused]] const std::byte* arguments) noexcept
        TAPPET_REALTIME {
        bool good = true;
        static_cast<void>((captures_of<number>(transition, execution, arguments, good) || ...));
        return good;
    }
};

} // namespace native

} // namespace tappet
