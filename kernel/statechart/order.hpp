// The order of execution of a state machine (thesis 5.2), written once: event dispatch, one transition, one
// step in automatic mode. `Table` gives access to the machine: in memory (in_memory.hpp), where rows are read
// and execution continues from wherever it stopped; or in constants (native.hpp), which the compiler folds
// and where execution starts. When it stops, the execution holds all that is needed to continue. The numbers
// before a function are the lines of kernel/statechart/README.md that it implements.
#pragma once

#include "kernel/statechart/execution.hpp"

namespace tappet::statechart {

/// Tells the visitor how to continue.
enum class Flow : std::uint8_t { on, next_leaf, stop };

template <class Table> struct Order {
    using Execution = StateMachineExecution;
    using Answer = Execution::Answer;
    using Call = Execution::Call;

    // ---- one program, one step of a transition

    // Returns whether the program ended and nothing else caused an error in the meantime.
    template <class Program, class Step>
    [[gnu::always_inline]] static bool perform(Execution& e, Program program, StatePart part,
                                               StateIndex state, Step step, Call& call) noexcept
        TAPPET_REALTIME {
        if (program.empty()) return true;
        if (Table::lacks_statements(call)) [[unlikely]]
            return e.lacks_statements();
        if (program.is_function()) {
            --call.left;
            program.call(e.context_.component);
        } else if (!program.run_to_end(e, part, state, step, call)) [[unlikely]] {
            return false;
        }
        return program.is_private() || !e.is(Execution::error);
    }

    // 1, 2, 3, 4, 5, 6, 8
    template <StepKind kind, class Arc, class Step>
    [[gnu::always_inline]] static bool run_step(Execution& e, Arc arc, Step step, Call& call) noexcept
        TAPPET_REALTIME {
        if constexpr (kind == StepKind::act) {
            return perform(e, arc.then(), StatePart::then, arc.row().source, step, call);
        } else if constexpr (kind == StepKind::otherwise) {
            return perform(e, arc.otherwise(), StatePart::otherwise, arc.row().source, step, call);
        } else if constexpr (kind == StepKind::leave) {
            return Table::for_each_left(
                e, step, [&] [[gnu::always_inline]] (auto state) noexcept TAPPET_REALTIME {
                    if (!perform(e, state.exit(), StatePart::exit, state.number(), step, call)) return false;
                    Table::remove(e, state);
                    return true;
                });
        } else if constexpr (kind == StepKind::place) {
            Table::place(e, step);
            return true;
        } else if constexpr (kind == StepKind::entry) {
            return perform(e, step.state().entry(), StatePart::entry, step.row().state, step, call);
        } else if constexpr (kind == StepKind::remembered) {
            return Table::for_each_remembered(
                e, [&] [[gnu::always_inline]] (auto state) noexcept TAPPET_REALTIME {
                    return perform(e, state.entry(), StatePart::entry, state.number(), step, call);
                });
        } else if constexpr (kind == StepKind::handle) {
            if (!perform(e, step.state().handle(), StatePart::handle, step.row().state, step, call))
                return false;
            Table::is_done(e);
            return true;
        } else if constexpr (kind == StepKind::depart) {
            e.depart();
            return true;
        } else {
            static_assert(kind == StepKind::arrive);
            const StateIndex from = Table::left_leaf(e), to = Table::reached(e, step);
            Table::is_done(e);
            e.status_.last_transition = arc.row().transition;
            ++e.status_.transitions;
            if (e.trace_ != nullptr) [[unlikely]]
                e.trace_(e.trace_context_, from, to, arc.row().transition, e.context_.now);
            return true;
        }
    }

    // Executes the current job, then all transitions selected by one event. Returns true when no job is left.
    template <class Arc, class Steps>
    [[gnu::always_inline]] static bool run_steps(Execution& e, Arc arc, Steps steps, Call& call) noexcept
        TAPPET_REALTIME {
        if constexpr (Table::is_constant) {
            return Table::for_each_step(e, steps,
                                        [&]<StepKind kind> [[gnu::always_inline]] (auto step) noexcept
                                        TAPPET_REALTIME { return run_step<kind>(e, arc, step, call); });
        } else {
            return resume(e, call);
        }
    }
    static bool resume(Execution& e, Call& call) noexcept TAPPET_REALTIME {
        for (;;) {
            if (e.is(Execution::error)) return false;
            if (e.job_.at != no_step) {
                const bool has_ended = Table::for_each_step(
                    e, 0, [&]<StepKind kind> [[gnu::always_inline]] (auto step) noexcept TAPPET_REALTIME {
                        return run_step<kind>(e, Table::arc_in_hand(e), step, call);
                    });
                if (!has_ended) return false;
            } else if (e.selected_.empty() || e.is(Execution::final_wanted)) {
                e.selected_.clear();
                e.clear(Execution::in_hand);
                return true;
            } else {
                const auto next = e.selected_[0];
                for (std::size_t i = 1; i < e.selected_.size(); ++i) e.selected_[i - 1] = e.selected_[i];
                --e.selected_.used;
                const auto arc = Table::arc_of(e, next.arc);
                next.otherwise ? begin<true>(e, arc) : begin<false>(e, arc);
            }
        }
    }
    template <bool otherwise, class Arc>
    [[gnu::always_inline]] static void begin(Execution& e, Arc arc) noexcept TAPPET_REALTIME {
        if constexpr (!Table::is_constant) e.holds(Table::template job<otherwise>(e, arc));
        if (!otherwise && arc.row().gives_reason) e.give_reason(arc.row().transition, arc.because());
        Table::asks_again(e);
    }
    template <bool otherwise, class Arc>
    [[gnu::always_inline]] static bool fire(Execution& e, Arc arc, Call& call) noexcept TAPPET_REALTIME {
        begin<otherwise>(e, arc);
        return run_steps(e, arc, arc.template steps<otherwise>(), call);
    }
    // Returns false when the handle program did not end.
    template <class State>
    [[gnu::always_inline]] static bool handle(Execution& e, State state, Call& call) noexcept
        TAPPET_REALTIME {
        if (state.handle().empty()) return true;
        if constexpr (!Table::is_constant) e.holds({.at = e.machine_.plans[state.number()].handle});
        return run_steps(e, Table::no_arc(), state.handle_steps(), call);
    }

    // ---- selecting a transition

    // 7, 50
    template <bool otherwise, class Arc>
    [[gnu::always_inline]] static Answer may_enter(Execution& e, Arc arc) noexcept TAPPET_REALTIME {
        Answer answer = Answer::yes;
        if (Table::has_preconditions(e))
            Table::template for_each_entered<otherwise>(
                e, arc, [&] [[gnu::always_inline]] (auto state) noexcept TAPPET_REALTIME {
                    answer = Table::ask(e, state.precondition());
                    return answer == Answer::yes;
                });
        return answer;
    }
    // 10, 11, 14
    template <class Arc>
    [[gnu::always_inline]] static Answer evaluate(Execution& e, Arc arc, const std::byte* arguments,
                                                  TransitionIndex& refused_by) noexcept TAPPET_REALTIME {
        if (arc.row().after != Duration{} &&
            e.context_.now < Execution::due(arc.row(), Table::source_of(e, arc).entered_at))
            return Answer::no;
        if (arc.row().captures && !Table::captures(e, arc, arguments)) [[unlikely]]
            return e.refuses(StatePart::capture, arc.row());
        e.context_.position.entered = false; // a guard has not waited for anything
        Answer answer = Table::ask(e, arc.guard());
        if (arc.row().tells_refusal && answer == Answer::no && refused_by == no_transition)
            refused_by = arc.row().transition;
        if (answer == Answer::yes) answer = may_enter<false>(e, arc);
        if (answer == Answer::no && arc.row().has_otherwise) {
            answer = may_enter<true>(e, arc);
            if (answer == Answer::yes) answer = Answer::otherwise;
        }
        return answer == Answer::failed ? e.refuses(StatePart::guard, arc.row()) : answer;
    }

    // An event: 10, 12, 13. No program runs before all regions have been evaluated.
    template <class Cell>
    [[gnu::always_inline]] static bool dispatch(Execution& e, Cell cell, const std::byte* arguments,
                                                Call& call) noexcept TAPPET_REALTIME {
        StateIndex refused = no_state;
        TransitionIndex refused_by = no_transition;
        bool is_taken = false, has_failed = false;
        Table::for_each_asked(
            e, cell, [&] [[gnu::always_inline]] (auto leaf, auto arc) noexcept TAPPET_REALTIME {
                if (!Table::is_asked_from(e, leaf, arc)) return Flow::next_leaf;
                if (Table::is_inside_selected(e, arc)) return Flow::on;
                const Answer answer = evaluate(e, arc, arguments, refused_by);
                if (answer == Answer::no) {
                    if (refused == no_state) refused = arc.row().source;
                    return Flow::on;
                }
                if (answer == Answer::failed) [[unlikely]] {
                    has_failed = true;
                    return Flow::stop;
                }
                is_taken = true;
                if (!Table::takes_at_once(e)) {
                    static_cast<void>(
                        e.selected_.push({arc.row().source, arc.number(), answer == Answer::otherwise}));
                    return Flow::on;
                }
                static_cast<void>(answer == Answer::yes ? fire<false>(e, arc, call)
                                                        : fire<true>(e, arc, call));
                return Flow::stop;
            });
        if (has_failed) [[unlikely]] {
            e.selected_.clear();
            return false;
        }
        if (is_taken) {
            if constexpr (!Table::is_constant)
                if (!e.selected_.empty()) {
                    e.set(Execution::in_hand);
                    if (!Table::is_single(e)) static_cast<void>(resume(e, call));
                }
        } else if (refused != no_state) {
            if (refused_by != no_transition) e.tell_refusal(refused_by);
            static_cast<void>(handle(e, Table::first_asked(e, cell, refused), call));
        }
        return is_taken;
    }

    // ---- a step in automatic mode

    // 21, 25
    template <class State>
    [[gnu::always_inline]] static bool run_active(Execution& e, State state, Call& call) noexcept
        TAPPET_REALTIME {
        ActiveState& at = state.at(e);
        if (at.run != RunPhase::fresh && at.run != RunPhase::under_way) return true;
        const auto program = state.run();
        if (program.empty()) {
            at.run = RunPhase::ran;
            return true;
        }
        const bool begins = at.run == RunPhase::fresh;
        if (begins) {
            if (e.has_run(state.number())) {
                at.run = RunPhase::held;
                return true;
            }
            if (Table::lacks_statements(call)) [[unlikely]]
                return e.lacks_statements();
        }
        e.note_run(state.number());
        at.run = RunPhase::ran;
        if (program.is_function()) {
            --call.left;
            program.call(e.context_.component);
        } else if (begins ? !program.begin(e, at, call) : !e.resume_running(at, call)) [[unlikely]] {
            return false;
        }
        return program.is_private() || !e.is(Execution::error);
    }

    enum class Found : std::uint8_t { nothing, taken, halted };

    // 22: innermost states first; states around several leaves after all of those.
    [[gnu::always_inline]] static Found find_transition(Execution& e, Call& call) noexcept TAPPET_REALTIME {
        Found found = Found::nothing;
        std::uint32_t number = 0;
        TransitionIndex of_no_event = no_transition;
        Table::for_each_asked(
            e, Table::conditions(),
            [&] [[gnu::always_inline]] (auto leaf, auto arc) noexcept TAPPET_REALTIME {
                if (!Table::is_asked_from(e, leaf, arc)) return Flow::next_leaf;
                // A time-out is an event of time: it does not wait for the run program.
                const RunPhase phase = Table::source_of(e, arc).run;
                if (phase != RunPhase::ran && (phase != RunPhase::waits || arc.row().after == Duration{}))
                    return Flow::on;
                if (Table::is_single(e)) {
                    if (number++ < e.asked_) return Flow::on;
                    found = call.left <= 0 ? Found::halted : Found::nothing;
                    if (found == Found::halted) {
                        static_cast<void>(e.lacks_statements());
                        return Flow::stop;
                    }
                    --call.left;
                    ++e.asked_;
                }
                const Answer answer = evaluate(e, arc, nullptr, of_no_event);
                if (answer == Answer::no || answer == Answer::otherwise) return Flow::on;
                found = answer == Answer::yes && fire<false>(e, arc, call) ? Found::taken : Found::halted;
                return Flow::stop;
            });
        return found;
    }

    // 24
    [[gnu::always_inline]] static bool handle_all(Execution& e, Call& call) noexcept TAPPET_REALTIME {
        const bool all =
            Table::for_each_active(e, [&] [[gnu::always_inline]] (auto state) noexcept TAPPET_REALTIME {
                ActiveState& at = state.at(e);
                if (at.run != RunPhase::ran && at.run != RunPhase::asked) return true;
                at.run = RunPhase::done;
                return handle(e, state, call);
            });
        if (!all) [[unlikely]]
            e.has_asked_all();
        return all;
    }

    // One round of run programs, conditions and handle programs: 21 - 24. True: another round follows in this
    // step.
    [[gnu::always_inline]] static bool run_round(Execution& e, std::size_t& taken, Call& call) noexcept
        TAPPET_REALTIME {
        const auto serves_final = [&]() noexcept TAPPET_REALTIME {
            call = e.serve_final(call);
            return (e.mode_ & (Execution::in_hand | Execution::error)) == 0;
        };
        if (!Table::for_each_active(e, [&] [[gnu::always_inline]] (auto state) noexcept
                                    TAPPET_REALTIME { return run_active(e, state, call); }))
            return false;
        if (e.is(Execution::final_wanted)) [[unlikely]]
            return serves_final();
        if (Table::is_automatic(e)) {
            switch (find_transition(e, call)) {
            case Found::halted: return false;
            case Found::taken:
                if (e.is(Execution::final_wanted) && !serves_final()) return false;
                e.conditions_left_ = ++taken == Execution::max_transitions_per_step;
                if (e.conditions_left_) e.clear(Execution::mid_round);
                return !e.conditions_left_;
            case Found::nothing: break;
            }
            if (!handle_all(e, call)) return false;
        } else {
            for (const ActiveState& active : e.status_.states)
                if (active.run == RunPhase::waits) return false;
        }
        e.run_once_ = false;
        e.clear(Execution::mid_round);
        return false;
    }
};

} // namespace tappet::statechart
