// The rows of a constant state machine as types, for order.hpp: the compiler knows every row.
#pragma once

#include "kernel/program/native.hpp"
#include "kernel/statechart/order.hpp"
#include "kernel/statechart/rows.hpp"

namespace tappet {

/// Gives native code the state machine: see tables_of() in kernel/program/native.hpp.
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

/// Calls visit.operator()<i>() for each i below `count`, until one returns false.
template <std::size_t count, class Visit>
[[gnu::always_inline]] constexpr bool for_each_below(const Visit& visit) noexcept TAPPET_REALTIME {
    return [&]<std::size_t... i> [[gnu::always_inline]] (std::index_sequence<i...>) noexcept TAPPET_REALTIME {
        return (visit.template operator()<i>() && ...);
    }(std::make_index_sequence<count>{});
}

template <const auto& source, std::size_t type> struct MachineRows {
    using Programs = Code<source, type>;
    using Execution = StateMachineExecution;
    using Answer = Execution::Answer;
    using Call = Execution::Call;
    static constexpr ResolvedView view = resolved_type<source, type>.view();

    // ---- statements

    static constexpr std::uint32_t statements_of(const ProgramRef& program) {
        return program.program != no_program ? Programs::facts[program.program].statements : !program.empty();
    }
    /// Upper bound for one call: so many rounds in a leaf and transitions from it, and after each one to the
    /// final state by request.
    static constexpr std::uint64_t most_statements = [] {
        std::uint64_t most_in_leaf = 0, most_on_the_way = 0;
        for (std::size_t leaf = 0; leaf < view.sizes.states; ++leaf) {
            std::uint64_t all = 0;
            for (auto s = static_cast<StateIndex>(leaf); s != no_state; s = view.plans[s].parent) {
                const StateRow& row = view.table.states[s];
                for (const ProgramRef* each : {&row.run, &row.handle, &row.exit, &row.entry})
                    all += statements_of(*each);
            }
            most_in_leaf = std::max(most_in_leaf, all);
        }
        for (const TransitionRow& row : view.table.transitions)
            for (const ProgramRef* each : {&row.then, &row.otherwise})
                most_on_the_way = std::max<std::uint64_t>(most_on_the_way, statements_of(*each));
        return (most_in_leaf + most_on_the_way) * (2 * Execution::max_transitions_per_step + 2);
    }();
    /// Below the bound, statements are not counted.
    static constexpr bool counts = most_statements >= Programs::unbounded;

    // ---- programs and conditions

    [[gnu::noinline, gnu::cold]] static ProgramReturn halts(Execution& e, ProgramPosition& position,
                                                            bool stands, NextNode next) noexcept
        TAPPET_REALTIME {
        const ProgramReturn why = returns_at(next, e.context_, stands);
        position = e.context_.position;
        return why;
    }
    template <StateProgram function, ProgramIndex number> struct Program {
        static constexpr bool empty() noexcept TAPPET_REALTIME {
            return function == nullptr && number == no_program;
        }
        static constexpr bool is_function() noexcept TAPPET_REALTIME { return function != nullptr; }
        static constexpr bool is_private() noexcept TAPPET_REALTIME {
            return number != no_program && Programs::facts[number].is_private;
        }
        [[gnu::always_inline]] static void call([[maybe_unused]] void* component) noexcept TAPPET_REALTIME {
            if constexpr (function != nullptr) function(component);
        }
        // Runs from its beginning; calls `stopped(stands, next)` when it does not end.
        template <class Stopped>
        [[gnu::always_inline]] static bool run_nodes([[maybe_unused]] Execution& e,
                                                     [[maybe_unused]] Call& call,
                                                     [[maybe_unused]] const Stopped& stopped) noexcept
            TAPPET_REALTIME {
            if constexpr (number != no_program) {
                ProgramRun run{e.context_.data, call.left, false, counts};
                const NextNode next = Programs::template program<number>(e.context_, run);
                call.left = run.left;
                if (next >= halted) [[unlikely]]
                    return stopped(run.stands, next);
            }
            return true;
        }
        [[gnu::always_inline]] static bool begin(Execution& e, ActiveState& at, Call& call) noexcept
            TAPPET_REALTIME {
            return run_nodes(e, call, [&](bool stands, NextNode next) noexcept TAPPET_REALTIME {
                return e.has_not_run(at, halts(e, at.position, stands, next));
            });
        }
        template <class Step>
        [[gnu::always_inline]] static bool run_to_end(Execution& e, StatePart part, StateIndex state,
                                                      Step step, Call& call) noexcept TAPPET_REALTIME {
            return run_nodes(e, call, [&](bool stands, NextNode next) noexcept TAPPET_REALTIME {
                const ProgramReturn why = halts(e, e.position_, stands, next);
                e.program_begun_ = true;
                step.stands(e);
                static_cast<void>(e.breaks_off(why, part, state, e.position_.node));
                return false;
            });
        }
    };
    template <StateGuard function, ConditionIndex number> struct Condition {
        [[gnu::always_inline]] static Answer ask([[maybe_unused]] Execution& e) noexcept TAPPET_REALTIME {
            if constexpr (function != nullptr) {
                return function(e.context_.component) ? Answer::yes : Answer::no;
            } else {
                alignas(data_alignment) std::byte scratch[Programs::scratch_bytes];
                return Execution::answer_of(
                    Programs::template condition<number>(e.context_, e.context_.data, scratch));
            }
        }
    };

    // ---- rows

    template <StateIndex index> struct State {
        static constexpr const StateRow& row = view.table.states[index];
        static constexpr std::size_t place = view.plans[index].depth - 1u;
        static constexpr StateIndex number() noexcept TAPPET_REALTIME { return index; }
        static ActiveState& at(Execution& e) noexcept TAPPET_REALTIME { return e.status_.states[place]; }
#define TAPPET_PROGRAM(name)                                                                                 \
    static constexpr auto name() noexcept TAPPET_REALTIME {                                                  \
        return Program<row.name.call, row.name.program>{};                                                   \
    }
        TAPPET_PROGRAM(entry)
        TAPPET_PROGRAM(exit)
        TAPPET_PROGRAM(run)
        TAPPET_PROGRAM(handle)
        static constexpr auto precondition() noexcept TAPPET_REALTIME {
            return Condition<row.precondition.call, row.precondition.condition>{};
        }
        static constexpr auto handle_steps() noexcept TAPPET_REALTIME {
            return Steps<view.plans[index].handle, no_arc, false>{};
        }
    };
    template <ArcIndex index> struct Arc {
        static constexpr const StateArc& arc = view.arcs[index];
        static constexpr const TransitionRow& row_ = view.table.transitions[arc.transition];
        static constexpr const StateArc& row() noexcept TAPPET_REALTIME { return arc; }
        static constexpr ArcIndex number() noexcept TAPPET_REALTIME { return index; }
        static constexpr std::string_view because() noexcept TAPPET_REALTIME { return row_.because; }
        static constexpr auto guard() noexcept TAPPET_REALTIME {
            return Condition<arc.guard.call, arc.guard.condition>{};
        }
        static constexpr auto then() noexcept TAPPET_REALTIME {
            return Program<row_.then.call, row_.then.program>{};
        }
        static constexpr auto otherwise() noexcept TAPPET_REALTIME {
            return Program<row_.otherwise.call, row_.otherwise.program>{};
        }
        template <bool otherwise> static constexpr auto steps() noexcept TAPPET_REALTIME {
            return Steps<otherwise ? arc.otherwise_steps : arc.steps, index, otherwise>{};
        }
    };
#undef TAPPET_PROGRAM
    /// The steps of one branch of an arc; of a handle program: without an arc.
    template <StepIndex from, ArcIndex of, bool is_otherwise> struct Steps {
        static constexpr StepIndex first = from;
        static constexpr ArcIndex arc = of;
        static constexpr bool otherwise = is_otherwise;
        static constexpr std::size_t count = [] {
            std::size_t steps = 0;
            if (first != no_step)
                while (!is_last(view.steps[first + steps++].kind)) {
                }
            return steps;
        }();
    };
    template <StepIndex index, class List, StateIndex leaf> struct Step {
        static constexpr const TransitionStep& row() noexcept TAPPET_REALTIME { return view.steps[index]; }
        static constexpr State<view.steps[index].state> state() noexcept TAPPET_REALTIME { return {}; }
        /// Leaves the execution to the loaded form at this step.
        [[gnu::always_inline]] static void stands(Execution& e) noexcept TAPPET_REALTIME {
            if constexpr (List::arc == no_arc) {
                e.stands_at(index, no_arc, no_state, 0);
            } else {
                constexpr StateArc row = view.arcs[List::arc];
                e.stands_at(index, List::arc, leaf, List::otherwise ? row.otherwise_kept : row.kept_levels);
            }
        }
    };
    /// Arcs that are evaluated one after the other.
    template <AskedIndex first> struct Asked {
        static constexpr std::size_t count = [] {
            std::size_t arcs = 0;
            if (first != none_asked)
                while (!view.asked[first + arcs++].is_last()) {
                }
            return arcs;
        }();
    };

    // ---- the arguments of an event

    template <std::size_t transition> static bool captures(Execution& e, const std::byte* arguments) noexcept
        TAPPET_REALTIME {
        constexpr TransitionRow row = view.table.transitions[transition];
        alignas(data_alignment) std::byte scratch[Programs::scratch_bytes];
        std::byte* const data = e.context_.data;
        return for_each_below<row.captures>(
            [&]<std::size_t i> [[gnu::always_inline]] () noexcept TAPPET_REALTIME {
                constexpr CaptureRow each = view.table.captures[row.first_capture + i];
                std::memcpy(Programs::template write<each.raw>(data, scratch), arguments + each.from,
                            each.size);
                return Programs::template instructions<each.first>(std::make_index_sequence<each.count>{},
                                                                   e.context_, data,
                                                                   scratch) == ActionResult::done;
            });
    }
    // For a transition that is taken in memory.
    static bool capture(Execution& e, TransitionIndex transition, const std::byte* arguments) noexcept
        TAPPET_REALTIME {
        bool good = true;
        static_cast<void>(
            for_each_below<view.table.transitions.size()>([&]<std::size_t number>() noexcept TAPPET_REALTIME {
                if constexpr (view.table.transitions[number].captures != 0)
                    if (transition == number) {
                        good = captures<number>(e, arguments);
                        return false;
                    }
                return true;
            }));
        return good;
    }
};

} // namespace native
} // namespace tappet
