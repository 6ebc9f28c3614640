// Native code of a step of a constant state machine: its rounds of run programs, conditions and handle
// programs, each leaf's a function that leads on to the next one's.
#pragma once

#include "kernel/statechart/native_transition.hpp"

namespace tappet::native {

template <const auto& source, std::size_t type> struct StepCode {
    using Transition = TransitionCode<source, type>;
    using Programs = Code<source, type>;
    using Execution = StateMachineExecution;
    using Extent = Transition::Extent;
    using Round = Execution::Round;
    static constexpr const ResolvedView& view = Transition::view;
    static constexpr bool is_folded = Transition::is_folded;

    // ---- what is known of the table

    static constexpr std::size_t count_arcs(ArcIndex first) {
        if (first == no_arc) return 0;
        std::size_t count = 1;
        while (!view.arcs[first + count - 1].last) ++count;
        return count;
    }
    static constexpr std::size_t leaf_count = [] {
        std::size_t count = 0;
        for (std::size_t i = 0; i < view.sizes.states; ++i) count += view.plans[i].regions == 0;
        return count;
    }();
    static constexpr std::array<StateIndex, leaf_count> leaves = [] {
        std::array<StateIndex, leaf_count> all{};
        for (std::size_t i = 0, used = 0; i < view.sizes.states; ++i)
            if (view.plans[i].regions == 0) all[used++] = static_cast<StateIndex>(i);
        return all;
    }();

    // ---- the frame of an outer call

    // Nobody is called who could call back: nobody sees that the machine is busy.
    template <bool calls, bool counted>
    [[gnu::always_inline]] static Run begins(Execution& execution, Time now, std::int64_t statements) noexcept
        TAPPET_REALTIME {
        if constexpr (calls) execution.mode_ = Execution::busy;
        if constexpr (!is_folded) {
            execution.context_.now = now;
            execution.statements_left_ = false;
            return {execution.context_.data, statements, true, counted};
        } else {
            static_cast<void>(now), static_cast<void>(statements);
            return {nullptr, 0, true, false};
        }
    }
    // False: there is something to serve.
    template <bool calls>
    [[gnu::always_inline]] static bool ends(Execution& execution) noexcept TAPPET_REALTIME {
        if constexpr (!calls) return true;
        execution.clear(Execution::busy);
        return execution.mode_ == Execution::ready;
    }

    // ---- one round

    static constexpr std::size_t path_words = (view.sizes.states + 63) / 64;
    using Path = std::array<std::uint64_t, path_words>;
    // The active states as bits.
    static constexpr Path path_of(StateIndex leaf) {
        Path path{};
        for (StateIndex s = leaf; s != no_state; s = view.plans[s].parent)
            path[s / 64u] |= std::uint64_t{1} << (s % 64u);
        return path;
    }
    static constexpr std::size_t number_of(StateIndex leaf) {
        return static_cast<std::size_t>(std::ranges::find(leaves, leaf) - leaves.begin());
    }
    template <StateIndex leaf, std::size_t level>
    static constexpr StateRow row_at = view.table.states[Transition::ancestor(leaf, level + 1)];

    // All that one round in a leaf may run, up to the transition after it.
    static constexpr Extent extent_of(StateIndex leaf) {
        Extent extent = Transition::extent_of(leaf, view.plans[leaf].conditions, {});
        for (StateIndex s = leaf; s != no_state; s = view.plans[s].parent) {
            extent.add(view.table.states[s].run);
            extent.add(view.table.states[s].handle);
        }
        return extent;
    }

    template <StateIndex leaf> static constexpr Extent extent_at = extent_of(leaf);
    template <StateIndex leaf> static constexpr Path path_at = path_of(leaf);

    [[gnu::noinline, gnu::cold]] static void breaks_off_run(Execution& execution, std::int64_t statements,
                                                            bool fresh, Next next, std::size_t level,
                                                            Round round, Time now) noexcept TAPPET_REALTIME {
        const ProgramReturn why = Transition::breaks_off(execution, statements, fresh, next);
        execution.resume_run(round, level, why, now);
    }
    [[gnu::noinline, gnu::cold]] static void breaks_off_handle(Execution& execution, std::int64_t statements,
                                                               bool fresh, Next next, std::size_t level,
                                                               Round round, Time now) noexcept
        TAPPET_REALTIME {
        const ProgramReturn why = Transition::breaks_off(execution, statements, fresh, next);
        execution.resume_handle(round, level, why, now);
    }
    template <StateIndex leaf, std::size_t level>
    [[gnu::always_inline]] static bool runs_level(Execution& execution, Run& run, Round round,
                                                  Time now) noexcept TAPPET_REALTIME {
        constexpr ProgramRef program = row_at<leaf, level>.run;
        if constexpr (program.empty()) return true;
        if ((round.due >> level & 1u) == 0) return true;
        Next next = end_node;
        if (Transition::template performs<program.call, program.program>(execution, run, next)) [[likely]]
            return true;
        breaks_off_run(execution, run.statements, run.fresh, next, level, round, now);
        return false;
    }
    template <StateIndex leaf, std::size_t level>
    [[gnu::always_inline]] static bool handles_level(Execution& execution, Run& run, Round round,
                                                     Time now) noexcept TAPPET_REALTIME {
        constexpr ProgramRef program = row_at<leaf, level>.handle;
        if constexpr (program.empty()) return true;
        if ((round.held >> level & 1u) != 0) return true;
        Next next = end_node;
        if (Transition::template performs<program.call, program.program>(execution, run, next)) [[likely]]
            return true;
        breaks_off_handle(execution, run.statements, run.fresh, next, level, round, now);
        return false;
    }
    template <StateIndex leaf, std::size_t... level>
    [[gnu::always_inline]] static bool runs(std::index_sequence<level...>, Execution& execution, Run& run,
                                            Round round, Time now) noexcept TAPPET_REALTIME {
        return (runs_level<leaf, level>(execution, run, round, now) && ...);
    }
    template <StateIndex leaf, std::size_t... level>
    [[gnu::always_inline]] static bool handles(std::index_sequence<level...>, Execution& execution, Run& run,
                                               Round round, Time now) noexcept TAPPET_REALTIME {
        return (handles_level<leaf, level>(execution, run, round, now) && ...);
    }

    // What is entered runs unless it has run in this step: then it is held, and is not asked either.
    template <StateIndex leaf, StateIndex target, std::size_t level>
    [[gnu::always_inline]] static void enters_level(const Execution& execution, Round& round) noexcept
        TAPPET_REALTIME {
        constexpr StateIndex entered = Transition::ancestor(target, level + 1);
        if constexpr (!view.table.states[entered].run.empty()) {
            constexpr bool has_run = Transition::ancestor(leaf, level + 1) == entered;
            if (has_run || execution.has_run(entered))
                round.held = static_cast<std::uint8_t>(round.held | 1u << level);
            else
                round.due = static_cast<std::uint8_t>(round.due | 1u << level);
        }
    }
    template <StateIndex leaf, StateIndex target, std::size_t kept, std::size_t... level>
    [[gnu::always_inline]] static void enters(std::index_sequence<level...>, const Execution& execution,
                                              Round& round) noexcept TAPPET_REALTIME {
        constexpr auto kept_bits = static_cast<std::uint8_t>((1u << kept) - 1u);
        static_cast<void>(execution);
        round.due = 0;
        round.held &= kept_bits;
        (enters_level<leaf, target, kept + level>(execution, round), ...);
    }
    // A condition held: its transition, and the round after it.
    template <StateIndex leaf, ArcIndex arc>
    [[gnu::always_inline]] static void goes_over(Execution& execution, Run& run, Round round,
                                                 Time now) noexcept TAPPET_REALTIME {
        constexpr StateArc row = view.arcs[arc];
        constexpr const Path& path = path_at<leaf>;
        constexpr std::size_t levels = view.plans[leaf].depth;
        for (std::size_t word = 0; word < path_words; ++word)
            execution.ran_[word] = round.taken == 0 ? path[word] : execution.ran_[word] | path[word];
        Transition::template gives_reason<arc>(execution, now);
        Next next = end_node;
        std::size_t part = 0;
        if (!Transition::template performs_parts<leaf, arc>(
                std::make_index_sequence<Transition::template parts<leaf, arc>.count>{}, execution, run, next,
                part)) [[unlikely]] {
            execution.note_round(round, levels);
            return Transition::breaks_off_at(execution, run.statements, run.fresh, next, arc, part, now);
        }
        Transition::template arrives<leaf, arc>(execution, now);
        if (execution.trace_ != nullptr) {
            execution.tell(leaf, row.target, row.transition, now);
            if constexpr (!extent_at<leaf>.calls) execution.clear(Execution::busy);
        }
        enters<leaf, row.target, row.kept_levels>(
            std::make_index_sequence<std::size_t{row.target_levels} - row.kept_levels>{}, execution, round);
        round.statements = run.statements;
        ++round.taken;
        constexpr Extent before = extent_at<leaf>, after = extent_at<row.target>;
        constexpr bool may_lack = !is_folded && after.is_bounded();
        if (execution.mode_ != (before.calls ? Execution::busy : Execution::ready) ||
            (may_lack && round.statements < after.statements)) [[unlikely]]
            return execution.resume_round(round, row.kept_levels, now);
        if constexpr (before.calls && !after.calls) execution.mode_ = Execution::ready;
        execution.conditions_left_ = round.taken == Execution::max_transitions_per_step;
        if (execution.conditions_left_) {
            execution.mode_ = Execution::ready;
            return;
        }
        state<number_of(row.target)>(execution, now, round);
    }

    // True when the conditions after it are not asked.
    template <StateIndex leaf, ArcIndex arc>
    [[gnu::always_inline]] static bool holds(Execution& execution, Run& run, Round round, Time now) noexcept
        TAPPET_REALTIME {
        constexpr StateArc row = view.arcs[arc];
        if constexpr (!view.table.states[row.source].run.empty())
            if ((round.held >> row.source_level & 1u) != 0) return false;
        if constexpr (row.after != Duration{})
            if (now < Execution::due(row, execution.status_.states[row.source_level].entered_at))
                return false;
        const ConditionResult result = Transition::template may_take<arc>(execution, nullptr);
        if (result == ConditionResult::no) return false;
        if (result == ConditionResult::yes) [[likely]] {
            goes_over<leaf, arc>(execution, run, round, now);
        } else {
            round.statements = run.statements;
            execution.resume_round(round, view.plans[leaf].depth, now);
        }
        return true;
    }
    template <StateIndex leaf, ArcIndex first, std::size_t... i>
    [[gnu::always_inline]] static bool conditions(std::index_sequence<i...>, Execution& execution, Run& run,
                                                  Round round, Time now) noexcept TAPPET_REALTIME {
        static_cast<void>(execution), static_cast<void>(run), static_cast<void>(round),
            static_cast<void>(now);
        return (holds<leaf, first + i>(execution, run, round, now) || ...);
    }

    // Its run program waits since an earlier step.
    template <StateIndex leaf, std::size_t level>
    [[gnu::always_inline]] static bool waits_at(const Execution& execution) noexcept TAPPET_REALTIME {
        constexpr ProgramIndex program = row_at<leaf, level>.run.program;
        if constexpr (program == no_program)
            return false;
        else if constexpr (!Programs::tables.programs[program].may_wait)
            return false;
        else
            return execution.status_.states[level].run == RunPhase::waits;
    }
    template <StateIndex leaf, std::size_t... level>
    [[gnu::always_inline]] static bool waits(std::index_sequence<level...>,
                                             const Execution& execution) noexcept TAPPET_REALTIME {
        static_cast<void>(execution);
        return (waits_at<leaf, level>(execution) || ...);
    }

    // One round of run programs, conditions and handle programs, and those after it.
    template <std::size_t number>
    static void state(Execution& execution, Time now, Round round) noexcept TAPPET_REALTIME {
        constexpr StateIndex leaf = leaves[number];
        constexpr StatePlan plan = view.plans[leaf];
        constexpr const Extent& extent = extent_at<leaf>;
        constexpr auto levels = std::make_index_sequence<plan.depth>{};
        if (waits<leaf>(levels, execution)) return execution.step_generally(now);
        Run run = begins<extent.calls, !extent.is_bounded()>(execution, now, round.statements);
        if (!runs<leaf>(levels, execution, run, round, now)) [[unlikely]]
            return;
        if constexpr (extent.calls)
            if ((execution.mode_ & Execution::final_wanted) != 0) [[unlikely]] {
                round.statements = run.statements;
                return execution.resume_round(round, plan.depth, now);
            }
        if (conditions<leaf, plan.conditions>(std::make_index_sequence<count_arcs(plan.conditions)>{},
                                              execution, run, round, now))
            return;
        if (!handles<leaf>(levels, execution, run, round, now)) [[unlikely]]
            return;
        if (!ends<extent.calls>(execution)) [[unlikely]]
            static_cast<void>(execution.finish_with(StateOutcome::taken, run.statements, now));
    }
};

} // namespace tappet::native
