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
    enum class Reaction : std::uint8_t {
        on,       ///< nothing of it was taken
        taken,    ///< and done with
        by_table, ///< the walk asks what was asked last, and all after it
        handed    ///< the walk has gone on from where it stood, and has ended the call
    };

    // ---- what is known of what may run

    /// Of all that one call may run: how many statements at most, and whether it calls anybody, who could
    /// turn to this machine again.
    struct Extent {
        std::uint32_t statements = 0;
        bool calls = false;

        constexpr void add(std::uint32_t more) {
            const bool is_unbounded = statements == Programs::unbounded || more == Programs::unbounded;
            statements = is_unbounded ? Programs::unbounded : statements + more;
        }
        constexpr void add(const ProgramRef& program) {
            if (program.call != nullptr) {
                add(1);
                calls = true;
            } else if (program.program != no_program) {
                add(Programs::facts[program.program].statements);
                calls = calls || !Programs::facts[program.program].is_private;
            }
        }
        constexpr void ask(const ConditionRef& condition) {
            calls =
                calls || condition.call != nullptr || !Programs::is_private_condition(condition.condition);
        }
        [[nodiscard]] constexpr bool is_bounded() const { return statements != Programs::unbounded; }
    };
    // Asked and taken.
    static constexpr Extent extent_of(StateIndex leaf, const StateArc& arc) {
        const TransitionRow& transition = view.table.transitions[arc.transition];
        Extent extent;
        extent.ask(transition.guard);
        extent.calls = extent.calls || transition.captures != 0;
        const Parts parts = parts_of(leaf, arc);
        for (std::size_t i = 0; i < parts.count; ++i) extent.add(parts.list[i]);
        if (view.preconditions)
            for (std::size_t level = arc.kept_levels + 1u; level <= arc.target_levels; ++level)
                extent.ask(view.table.states[ancestor(arc.target, level)].precondition);
        return extent;
    }
    // At most one of them is taken, then `otherwise` is not run.
    static constexpr Extent extent_of(StateIndex leaf, ArcIndex first, const ProgramRef& otherwise) {
        Extent all;
        all.add(otherwise);
        if (first == no_arc) return all;
        for (ArcIndex arc = first;; ++arc) {
            const Extent one = extent_of(leaf, view.arcs[arc]);
            all.statements = std::max(all.statements, one.statements);
            all.calls = all.calls || one.calls;
            if (view.arcs[arc].last) return all;
        }
    }
    /// Some run program may last longer than a step: then its phase outlives the step.
    static constexpr bool runs_on = [] {
        for (const StateRow& row : view.table.states)
            if (row.run.program != no_program && Programs::tables.programs[row.run.program].may_wait)
                return true;
        return false;
    }();

    // ---- programs

    // True when it has ended. Otherwise `next` says how it stands; end_node: it has ended, but an error came
    // from elsewhere.
    template <StateProgram call, ProgramIndex number>
    [[gnu::always_inline]] static bool performs(Execution& execution, Run& run, Next& next) noexcept
        TAPPET_REALTIME {
        next = end_node;
        if constexpr (call != nullptr) {
            if constexpr (!is_folded)
                if (--run.statements < 0 && run.counted) [[unlikely]] {
                    next = halts_at(no_node, Halt::left_over);
                    return false;
                }
            call(execution.context_.component);
            if constexpr (!is_folded) return !execution.is(Execution::error);
        } else if constexpr (number != no_program) {
            const bool none_left = run.counted && run.statements == 0;
            next = Programs::template program<number>(execution.context_, run);
            if (next >= halted) [[unlikely]] {
                if (none_left) next = halts_at(no_node, Halt::left_over); // it has not begun
                return false;
            }
            if constexpr (!Programs::facts[number].is_private) return !execution.is(Execution::error);
        }
        return true;
    }
    // How a program stands that has not ended, or no program after it may run.
    static ProgramReturn breaks_off(Execution& execution, std::int64_t statements, bool fresh,
                                    Next next) noexcept TAPPET_REALTIME {
        Run run{execution.context_.data, statements, fresh};
        const ProgramReturn why = Programs::halts(execution.context_, run, next);
        execution.statements_ = static_cast<std::uint32_t>(run.statements);
        return why;
    }

    // ---- one transition

    [[gnu::noinline, gnu::cold]] static void breaks_off_at(Execution& execution, std::int64_t statements,
                                                           bool fresh, Next next, ArcIndex arc,
                                                           std::size_t part, Time now) noexcept
        TAPPET_REALTIME {
        execution.resume_transition(arc, part, breaks_off(execution, statements, fresh, next), now);
    }
    template <StateIndex leaf, ArcIndex arc, std::size_t part>
    [[gnu::always_inline]] static bool performs_part(Execution& execution, Run& run, Next& next,
                                                     std::size_t& at) noexcept TAPPET_REALTIME {
        constexpr ProgramRef program = parts<leaf, arc>.list[part];
        if (performs<program.call, program.program>(execution, run, next)) [[likely]]
            return true;
        at = part;
        return false;
    }
    // True when all have ended, otherwise it is the program of that part which has not.
    template <StateIndex leaf, ArcIndex arc, std::size_t... part>
    [[gnu::always_inline]] static bool performs_parts(std::index_sequence<part...>, Execution& execution,
                                                      Run& run, Next& next, std::size_t& at) noexcept
        TAPPET_REALTIME {
        static_cast<void>(execution), static_cast<void>(run), static_cast<void>(next), static_cast<void>(at);
        return (performs_part<leaf, arc, part>(execution, run, next, at) && ...);
    }
    // Only what changes is written.
    template <StateIndex leaf, ArcIndex arc, std::size_t level>
    [[gnu::always_inline]] static void enters_level(ActiveState& at, Time now) noexcept TAPPET_REALTIME {
        constexpr StateIndex entered = ancestor(view.arcs[arc].target, level + 1);
        constexpr bool was_another = level >= view.plans[leaf].depth || ancestor(leaf, level + 1) != entered;
        if constexpr (was_another) at.state = entered;
        if constexpr (runs_on) at.run = RunPhase::fresh;
        at.entered_at = now;
    }
    template <StateIndex leaf, ArcIndex arc, std::size_t... level>
    [[gnu::always_inline]] static void enters(std::index_sequence<level...>, Execution& execution,
                                              [[maybe_unused]] Time now) noexcept TAPPET_REALTIME {
        constexpr StateArc row = view.arcs[arc];
        auto& states = execution.status_.states;
        (enters_level<leaf, arc, row.kept_levels + level>(states[row.kept_levels + level], now), ...);
        if constexpr (view.plans[leaf].depth != row.target_levels) states.used = row.target_levels;
    }
    // After its programs.
    template <StateIndex leaf, ArcIndex arc>
    [[gnu::always_inline]] static void arrives(Execution& execution, Time now) noexcept TAPPET_REALTIME {
        constexpr StateArc row = view.arcs[arc];
        enters<leaf, arc>(std::make_index_sequence<std::size_t{row.target_levels} - row.kept_levels>{},
                          execution, now);
        StateMachineStatus& status = execution.status_;
        if constexpr (row.target != leaf) status.active = row.target;
        status.last_transition = row.transition;
        ++status.transitions;
    }
    template <ArcIndex arc>
    [[gnu::always_inline]] static void gives_reason(Execution& execution, Time now) noexcept TAPPET_REALTIME {
        constexpr StateArc row = view.arcs[arc];
        if constexpr (row.gives_reason)
            execution.give_reason(row.transition, view.table.transitions[row.transition].because, now);
        else
            static_cast<void>(execution), static_cast<void>(now);
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
