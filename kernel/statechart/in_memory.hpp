// A state machine in memory: order.hpp reads its rows here. Every execution that had to stop continues here,
// also that of a compiled machine.
#pragma once

#include "kernel/statechart/order.hpp"

namespace tappet::statechart {

/// `quick`: fast path for an idle machine, no regions, automatic mode. Nearly all steps take it.
template <bool quick> struct Memory {
    using Execution = StateMachineExecution;
    using Answer = Execution::Answer;
    using Call = Execution::Call;
    static constexpr bool is_constant = false;

    struct Program {
        const ProgramRef& ref;

        [[nodiscard]] bool empty() const noexcept TAPPET_REALTIME { return ref.empty(); }
        [[nodiscard]] bool is_function() const noexcept TAPPET_REALTIME { return ref.call != nullptr; }
        void call(void* component) const noexcept TAPPET_REALTIME { ref.call(component); }
        static constexpr bool is_private() noexcept TAPPET_REALTIME { return false; }
        // Starts a run program.
        bool begin(Execution& e, ActiveState& at, Call& call) const noexcept TAPPET_REALTIME {
            e.context_.position = {.node = first_node(e)};
            const ProgramReturn why = e.run(at.position, call);
            return why == ProgramReturn::ended || e.has_not_run(at, why);
        }
        // Runs the current program: from its beginning, or from where it stopped.
        template <class Step>
        bool run_to_end(Execution& e, StatePart part, StateIndex state, Step, Call& call) const noexcept
            TAPPET_REALTIME {
            e.context_.position = e.program_begun_ ? e.position_ : ProgramPosition{.node = first_node(e)};
            const ProgramReturn why = e.run(e.position_, call);
            e.program_begun_ = why != ProgramReturn::ended;
            return why == ProgramReturn::ended || e.breaks_off(why, part, state, e.position_.node);
        }

    private:
        [[nodiscard]] NodeIndex first_node(const Execution& e) const noexcept TAPPET_REALTIME {
            return e.code_.tables->programs[ref.program].first;
        }
    };
    struct State {
        const StateRow& row;
        StateIndex index;
        std::size_t place = 0; ///< index in the active states

        [[nodiscard]] StateIndex number() const noexcept TAPPET_REALTIME { return index; }
        [[nodiscard]] ActiveState& at(Execution& e) const noexcept TAPPET_REALTIME {
            return e.status_.states[place];
        }
        [[nodiscard]] Program entry() const noexcept TAPPET_REALTIME { return {row.entry}; }
        [[nodiscard]] Program exit() const noexcept TAPPET_REALTIME { return {row.exit}; }
        [[nodiscard]] Program run() const noexcept TAPPET_REALTIME { return {row.run}; }
        [[nodiscard]] Program handle() const noexcept TAPPET_REALTIME { return {row.handle}; }
        [[nodiscard]] static int handle_steps() noexcept TAPPET_REALTIME { return 0; }
        [[nodiscard]] const ConditionRef& precondition() const noexcept TAPPET_REALTIME {
            return row.precondition;
        }
    };
    struct Step {
        const Execution& e;
        const TransitionStep& step;

        [[nodiscard]] const TransitionStep& row() const noexcept TAPPET_REALTIME { return step; }
        [[nodiscard]] State state() const noexcept TAPPET_REALTIME { return {e.row(step.state), step.state}; }
    };
    struct Arc {
        const Execution* e = nullptr;
        const StateArc* arc = nullptr;

        [[nodiscard]] const StateArc& row() const noexcept TAPPET_REALTIME { return *arc; }
        [[nodiscard]] ArcIndex number() const noexcept TAPPET_REALTIME {
            return static_cast<ArcIndex>(arc - e->machine_.arcs);
        }
        [[nodiscard]] const ConditionRef& guard() const noexcept TAPPET_REALTIME { return arc->guard; }
        [[nodiscard]] Program then() const noexcept TAPPET_REALTIME { return {transition().then}; }
        [[nodiscard]] Program otherwise() const noexcept TAPPET_REALTIME { return {transition().otherwise}; }
        [[nodiscard]] std::string_view because() const noexcept TAPPET_REALTIME {
            return transition().because;
        }
        template <bool otherwise> [[nodiscard]] static int steps() noexcept TAPPET_REALTIME { return 0; }

    private:
        [[nodiscard]] const TransitionRow& transition() const noexcept TAPPET_REALTIME {
            return e->machine_.table.transitions[arc->transition];
        }
    };
    static Arc no_arc() noexcept TAPPET_REALTIME { return {}; }
    static Arc arc_of(const Execution& e, ArcIndex number) noexcept TAPPET_REALTIME {
        return {&e, e.machine_.arcs + number};
    }
    static Arc arc_in_hand(const Execution& e) noexcept TAPPET_REALTIME {
        return e.job_.arc == tappet::no_arc ? no_arc() : arc_of(e, e.job_.arc);
    }

    // ---- facts about the machine

    // With regions, all guards are evaluated before any program runs; a single step only selects.
    static bool is_plain(const Execution& e) noexcept TAPPET_REALTIME { return quick || e.machine_.plain; }
    static bool takes_at_once(const Execution& e) noexcept TAPPET_REALTIME {
        return is_plain(e) && !is_single(e);
    }
    static bool is_automatic(const Execution& e) noexcept TAPPET_REALTIME { return quick || e.automatic_; }
    static bool is_single(const Execution& e) noexcept TAPPET_REALTIME { return !quick && e.single_; }
    static bool has_preconditions(const Execution& e) noexcept TAPPET_REALTIME {
        return e.machine_.preconditions;
    }
    static bool lacks_statements(const Call& call) noexcept TAPPET_REALTIME { return call.left <= 0; }
    static void is_done(Execution& e) noexcept TAPPET_REALTIME { e.job_.at = no_step; }
    static ActiveState& source_of(Execution& e, Arc arc) noexcept TAPPET_REALTIME {
        return e.status_.states[is_plain(e) ? arc.row().source_level : e.index_of(arc.row().source)];
    }

    // ---- guards and preconditions

    static Answer ask(Execution& e, const ConditionRef& condition) noexcept TAPPET_REALTIME {
        if (condition.call != nullptr) return condition.call(e.context_.component) ? Answer::yes : Answer::no;
        if (condition.condition == no_condition) return Answer::yes;
        return Execution::answer_of(e.code_.test(*e.code_.tables, e.context_, condition.condition));
    }
    static bool captures(Execution& e, Arc arc, const std::byte* arguments) noexcept TAPPET_REALTIME {
        return e.capture(arc.row().transition, arguments);
    }

    /// The trigger to look up; no_trigger: the conditions.
    struct Cell {
        std::size_t trigger = no_trigger;
    };
    static Cell conditions() noexcept TAPPET_REALTIME { return {}; }
    struct Leaf {
        std::size_t place = 0;
    };
    template <class Visit>
    [[gnu::always_inline]] static void for_each_asked(Execution& e, Cell cell, const Visit& visit) noexcept
        TAPPET_REALTIME {
        const ResolvedView& machine = e.machine_;
        const auto& states = e.status_.states;
        for (std::size_t leaf = is_plain(e) ? states.size() - 1 : 0; leaf < states.size(); ++leaf) {
            const StateIndex state = states[leaf].state;
            const StatePlan& plan = machine.plans[state];
            if (plan.regions != 0) continue;
            AskedIndex first = plan.conditions;
            if (cell.trigger != no_trigger)
                first = machine.cells[state * machine.triggers.size() + cell.trigger];
            if (first == none_asked) continue;
            for (const AskedArc* asked = machine.asked + first;; ++asked) {
                const Flow flow = visit(Leaf{leaf}, arc_of(e, asked->arc()));
                if (flow == Flow::stop) return;
                if (flow == Flow::next_leaf || asked->is_last()) break;
            }
            if (quick) return;
        }
    }
    // Only the last leaf inside the source evaluates the transition.
    static bool is_asked_from(const Execution& e, Leaf leaf, Arc arc) noexcept TAPPET_REALTIME {
        return is_plain(e) || e.end_of(e.index_of(arc.row().source)) == leaf.place + 1;
    }
    static bool is_inside_selected(const Execution& e, Arc arc) noexcept TAPPET_REALTIME {
        for (const auto& each : e.selected_)
            if (e.machine_.is_inside(each.source, arc.row().source)) return true;
        return false;
    }
    static State first_asked(const Execution& e, Cell, StateIndex refused) noexcept TAPPET_REALTIME {
        return {e.row(refused), refused};
    }
    template <bool otherwise, class Visit>
    static void for_each_entered(Execution& e, Arc arc, const Visit& visit) noexcept TAPPET_REALTIME {
        const auto visits = [&](StateIndex state) noexcept
            TAPPET_REALTIME { return visit(State{e.row(state), state}); };
        const StateArc& row = arc.row();
        for (StepIndex at = otherwise ? row.otherwise_steps : row.steps;; ++at) {
            const TransitionStep& step = e.machine_.steps[at];
            if (is_last(step.kind)) return;
            if (step.kind == StepKind::place && !visits(step.state)) return;
            if (step.kind != StepKind::remembered) continue;
            Entering states;
            e.plan_remembered(states, row);
            for (StateIndex state : states)
                if (!visits(state)) return;
        }
    }

    // ---- one transition

    template <bool otherwise> static Execution::Job job(const Execution& e, Arc arc) noexcept
        TAPPET_REALTIME {
        const StateArc& row = arc.row();
        const auto& states = e.status_.states;
        Execution::Job job;
        job.at = otherwise ? row.otherwise_steps : row.steps;
        job.arc = arc.number();
        job.from = is_plain(e) ? e.status_.active : states[e.end_of(e.index_of(row.source)) - 1].state;
        if ((otherwise ? row.otherwise : row.to) == no_state) return job;
        const std::size_t kept = otherwise ? row.otherwise_kept : row.kept_levels;
        const std::size_t first = is_plain(e) ? kept : e.index_of(e.machine_.ancestor(row.source, kept + 1u));
        job.first = static_cast<std::uint8_t>(first);
        job.end = static_cast<std::uint8_t>(is_plain(e) ? states.size() : e.end_of(first));
        return job;
    }
    // The next step evaluates the conditions again.
    static void asks_again(Execution& e) noexcept TAPPET_REALTIME {
        for (ActiveState& active : e.status_.states)
            if (active.run == RunPhase::asked) active.run = RunPhase::ran;
        e.asked_ = 0;
    }
    template <class Visit>
    [[gnu::always_inline]] static bool for_each_step(Execution& e, int, const Visit& visit) noexcept
        TAPPET_REALTIME {
        for (;; ++e.job_.at) {
            const TransitionStep& row = e.machine_.steps[e.job_.at];
            const Step step{e, row};
            bool has_ended = false;
            switch (row.kind) {
#define TAPPET_STEP(kind)                                                                                    \
    case StepKind::kind: has_ended = visit.template operator()<StepKind::kind>(step); break
                TAPPET_STEP(act);
                TAPPET_STEP(otherwise);
                TAPPET_STEP(leave);
                TAPPET_STEP(place);
                TAPPET_STEP(entry);
                TAPPET_STEP(remembered);
                TAPPET_STEP(arrive);
                TAPPET_STEP(depart);
                TAPPET_STEP(handle);
#undef TAPPET_STEP
            }
            if (!has_ended || is_last(row.kind)) return has_ended;
        }
    }
    template <class Visit>
    [[gnu::always_inline]] static bool for_each_left(Execution& e, Step, const Visit& visit) noexcept
        TAPPET_REALTIME {
        while (e.job_.end > e.job_.first) {
            const std::size_t place = e.job_.end - 1u;
            const StateIndex state = e.status_.states[place].state;
            if (!visit(State{e.row(state), state, place})) return false;
        }
        return true;
    }
    static void remove(Execution& e, State) noexcept TAPPET_REALTIME {
        if constexpr (quick) {
            auto& states = e.status_.states;
            e.job_.end = static_cast<std::uint8_t>(--states.used);
            e.status_.active = states.empty() ? no_state : states[states.used - 1].state;
        } else {
            e.leaves_last();
        }
    }
    static void place(Execution& e, Step step) noexcept TAPPET_REALTIME {
        const StateIndex state = step.step.state;
        if constexpr (quick) {
            static_cast<void>(e.status_.states.push({state, RunPhase::fresh, {}, e.context_.now}));
            e.status_.active = state;
        } else {
            e.insert(std::size_t{e.job_.first} + step.step.number, state);
        }
    }
    template <class Visit>
    static bool for_each_remembered(Execution& e, const Visit& visit) noexcept TAPPET_REALTIME {
        Execution::Job& job = e.job_;
        if (job.remembered == 0 && !job.placed) e.plan_remembered(e.remembered_, e.machine_.arcs[job.arc]);
        for (; job.remembered < e.remembered_.size(); ++job.remembered) {
            const StateIndex state = e.remembered_[job.remembered];
            if (!job.placed) e.insert(std::size_t{job.first} + job.remembered, state);
            job.placed = true;
            if (!visit(State{e.row(state), state})) return false;
            job.placed = false;
        }
        return true;
    }
    static StateIndex left_leaf(const Execution& e) noexcept TAPPET_REALTIME { return e.job_.from; }
    static StateIndex reached(const Execution& e, Step step) noexcept TAPPET_REALTIME {
        if (step.step.state != no_state) return step.step.state;
        return e.job_.remembered != 0 ? e.remembered_[e.job_.remembered - 1u] : e.job_.from;
    }

    // ---- the active states

    template <class Visit>
    [[gnu::always_inline]] static bool for_each_active(Execution& e, const Visit& visit) noexcept
        TAPPET_REALTIME {
        for (std::size_t place = 0; place < e.status_.states.size(); ++place) {
            const StateIndex state = e.status_.states[place].state;
            if (!visit(State{e.row(state), state, place})) return false;
        }
        return true;
    }
};
using InMemory = Memory<false>;

} // namespace tappet::statechart
