// Native code made of a constant state machine: for each state and event the transitions are constants, so an
// event is a switch, and so is a step.
#pragma once

#include "kernel/statechart/native_transition.hpp"

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
    using Way = Transition::Way;
    static constexpr const ResolvedView& view = Transition::view;
    static constexpr bool is_folded = Transition::is_folded;

    // ---- what is known of the table

    static constexpr std::size_t count_arcs(ArcIndex first) {
        if (first == no_arc) return 0;
        std::size_t count = 1;
        while (!view.arcs[first + count - 1].last) ++count;
        return count;
    }
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

    // ---- an event

    // True when the arcs behind it are not asked.
    template <StateIndex leaf, ArcIndex arc>
    [[gnu::always_inline]] static bool reacts(Execution& execution, Run& run, Time now,
                                              const std::byte* arguments, Way& way, ArcIndex& asked) noexcept
        TAPPET_REALTIME {
        constexpr bool has_otherwise = view.table.transitions[view.arcs[arc].transition].has_otherwise;
        if constexpr (has_otherwise) { // asked there, once
            way = Way::by_table;
            asked = arc;
        } else {
            const ConditionResult result = Transition::template may_take<arc>(execution, arguments);
            if (result == ConditionResult::yes) {
                way = Transition::template takes<leaf, arc>(execution, run, now);
            } else if (result == ConditionResult::failed) {
                way = Way::by_table;
                asked = arc;
            }
        }
        return way != Way::on;
    }
    template <StateIndex leaf, ArcIndex first, std::size_t... i>
    [[gnu::always_inline]] static Way reacts(std::index_sequence<i...>, Execution& execution, Run& run,
                                             Time now, const std::byte* arguments, ArcIndex& asked) noexcept
        TAPPET_REALTIME {
        Way way = Way::on;
        static_cast<void>((reacts<leaf, first + i>(execution, run, now, arguments, way, asked) || ...));
        return way;
    }

    template <std::size_t number>
    static StateOutcome cell(Execution& execution, Time now, const std::byte* arguments) noexcept
        TAPPET_REALTIME {
        constexpr Cell at = cells[number];
        constexpr std::size_t arcs = count_arcs(at.first);
        constexpr ProgramRef handle = view.table.states[view.arcs[at.first].source].handle;
        if constexpr (view.captured[at.trigger] != 0)
            if (arguments == nullptr) return StateOutcome::ignored;
        Run run = begins(execution, now);
        ArcIndex asked = at.first + arcs;
        Way way = reacts<at.leaf, at.first>(std::make_index_sequence<arcs>{}, execution, run, now, arguments,
                                            asked);
        if (way == Way::handed) [[unlikely]]
            return StateOutcome::taken;
        if constexpr (!handle.empty())
            if (way == Way::on) {
                if constexpr (is_folded)
                    handle.call(execution.context_.component);
                else
                    way = Way::by_table;
            }
        if (way == Way::by_table) [[unlikely]]
            return execution.resume_event(at.trigger, now, arguments, asked);
        ends(execution, run, now);
        return way == Way::taken ? StateOutcome::taken : StateOutcome::ignored;
    }

    [[gnu::always_inline]] static Run begins(Execution& execution, Time now) noexcept TAPPET_REALTIME {
        execution.mode_ = Execution::busy;
        if constexpr (!is_folded) {
            execution.context_.now = now;
            execution.statements_left_ = false;
            return {execution.context_.data, execution.policy_.statements, true};
        } else {
            static_cast<void>(now);
            return {nullptr, 0, true};
        }
    }
    [[gnu::always_inline]] static void ends(Execution& execution, const Run& run, Time now) noexcept
        TAPPET_REALTIME {
        execution.mode_ = static_cast<std::uint8_t>(execution.mode_ & ~Execution::busy);
        if (execution.mode_ != Execution::ready) [[unlikely]] {
            execution.statements_ = static_cast<std::uint32_t>(run.statements);
            execution.finish(now);
        }
    }

    // ---- a step

    template <StateIndex leaf, std::size_t level>
    static constexpr StateRow row_at = view.table.states[Transition::ancestor(leaf, level + 1)];

    template <StateIndex leaf, std::size_t level>
    [[gnu::always_inline]] static bool runs_level(Execution& execution, Run& run, Time now) noexcept
        TAPPET_REALTIME {
        constexpr ProgramRef program = row_at<leaf, level>.run;
        if constexpr (program.empty()) return true;
        ProgramReturn why{};
        if (Transition::template performs<program.call, program.program>(execution, run, why)) [[likely]]
            return true;
        execution.statements_ = static_cast<std::uint32_t>(run.statements);
        execution.resume_run(level, why, now);
        return false;
    }
    template <StateIndex leaf, std::size_t level>
    [[gnu::always_inline]] static bool handles_level(Execution& execution, Run& run, Time now) noexcept
        TAPPET_REALTIME {
        constexpr ProgramRef program = row_at<leaf, level>.handle;
        if constexpr (program.empty()) return true;
        ProgramReturn why{};
        if (Transition::template performs<program.call, program.program>(execution, run, why)) [[likely]]
            return true;
        execution.statements_ = static_cast<std::uint32_t>(run.statements);
        execution.resume_handle(level, why, now);
        return false;
    }

    // True when the conditions behind it are not asked.
    template <StateIndex leaf, ArcIndex arc>
    [[gnu::always_inline]] static bool holds(Execution& execution, Run& run, Time now, Way& way) noexcept
        TAPPET_REALTIME {
        constexpr StateArc row = view.arcs[arc];
        if constexpr (row.after != Duration{})
            if (now < Execution::due(row, execution.status_.states[row.source_level].entered_at))
                return false;
        const ConditionResult result = Transition::template may_take<arc>(execution, nullptr);
        if (result == ConditionResult::no) return false;
        execution.note_round();
        way = result == ConditionResult::yes ? Transition::template takes<leaf, arc>(execution, run, now)
                                             : Way::by_table;
        return true;
    }
    template <StateIndex leaf, ArcIndex first, std::size_t... i>
    [[gnu::always_inline]] static Way conditions(std::index_sequence<i...>, Execution& execution,
                                                 [[maybe_unused]] Run& run,
                                                 [[maybe_unused]] Time now) noexcept TAPPET_REALTIME {
        static_cast<void>(execution);
        Way way = Way::on;
        static_cast<void>((holds<leaf, first + i>(execution, run, now, way) || ...));
        return way;
    }

    template <StateIndex leaf, std::size_t... level>
    [[gnu::always_inline]] static bool runs(std::index_sequence<level...>, Execution& execution, Run& run,
                                            Time now) noexcept TAPPET_REALTIME {
        return (runs_level<leaf, level>(execution, run, now) && ...);
    }
    template <StateIndex leaf, std::size_t... level>
    [[gnu::always_inline]] static bool handles(std::index_sequence<level...>, Execution& execution, Run& run,
                                               Time now) noexcept TAPPET_REALTIME {
        return (handles_level<leaf, level>(execution, run, now) && ...);
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

    template <std::size_t number>
    static void state(Execution& execution, Time now) noexcept TAPPET_REALTIME {
        constexpr StateIndex leaf = leaves[number];
        constexpr StatePlan plan = view.plans[leaf];
        constexpr auto levels = std::make_index_sequence<plan.depth>{};
        if (waits<leaf>(levels, execution)) return execution.step_generally(now);
        Run run = begins(execution, now);
        if (!runs<leaf>(levels, execution, run, now)) [[unlikely]]
            return;
        Way way = Way::by_table;
        if ((execution.mode_ & Execution::final_wanted) == 0) [[likely]]
            way = conditions<leaf, plan.conditions>(std::make_index_sequence<count_arcs(plan.conditions)>{},
                                                    execution, run, now);
        else
            execution.note_round();
        if (way == Way::handed) [[unlikely]]
            return;
        if (way != Way::on) {
            execution.statements_ =
                is_folded ? execution.policy_.statements : static_cast<std::uint32_t>(run.statements);
            execution.resume_round(way == Way::taken ? 1 : 0, now);
            return;
        }
        if (!handles<leaf>(levels, execution, run, now)) [[unlikely]]
            return;
        ends(execution, run, now);
    }

    // ---- the switches

    static constexpr std::size_t page_cells = 32;
    static constexpr std::uint32_t cell_key(std::size_t number) {
        if (number >= cell_count) return static_cast<std::uint32_t>(0x10000 + number); // none has it
        return static_cast<std::uint32_t>(cells[number].leaf * view.sizes.triggers + cells[number].trigger);
    }
    static constexpr std::uint32_t leaf_key(std::size_t number) {
        return number < leaf_count ? leaves[number] : static_cast<std::uint32_t>(0x10000 + number);
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
    [[gnu::always_inline]] static void steps_in(Execution& execution, Time now) noexcept TAPPET_REALTIME {
        if constexpr (number < leaf_count) state<number>(execution, now);
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
    [[gnu::always_inline]] static void step_in(std::uint32_t key, Execution& execution, Time now) noexcept
        TAPPET_REALTIME {
        constexpr std::size_t pages = (end - first + page_cells - 1) / page_cells;
        if constexpr (pages > 1) {
            constexpr std::size_t middle = first + pages / 2 * page_cells;
            key < leaf_key(middle) ? step_in<first, middle>(key, execution, now)
                                   : step_in<middle, end>(key, execution, now);
        } else {
#define TAPPET_ONE(number)                                                                                   \
    case leaf_key(first + number): return steps_in<first + number>(execution, now)
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
        return react_in<0, cell_count>(static_cast<std::uint32_t>(execution.first_cell_ + trigger), execution,
                                       now, arguments);
    }
    static bool capture(Execution& execution, TransitionIndex transition, const std::byte* arguments) noexcept
        TAPPET_REALTIME {
        return Transition::captures_of(std::make_index_sequence<Transition::capture_count>{}, transition,
                                       execution, arguments);
    }
    static void step(Execution& execution, Time now) noexcept TAPPET_REALTIME {
        step_in<0, leaf_count>(execution.status_.active, execution, now);
    }
};

template <const auto& source, std::size_t type>
constexpr StateMachineFast fast_of() noexcept {
    using Machine = MachineCode<source, type>;
    if constexpr (!Machine::view.plain)
        return {nullptr, nullptr, &Machine::capture};
    else
        return {&Machine::dispatch, &Machine::step, &Machine::capture};
}

} // namespace native

/// The quick path of a constant state machine as native code, for StateMachineBinding::fast. One with
/// orthogonal regions or history is walked; its programs and conditions are native all the same. `source`: a
/// StateMachine of rows.hpp, or a ScriptUnit with the number of a type; a variable at namespace scope.
template <const auto& source, std::size_t type = 0>
inline constexpr StateMachineFast native_machine = native::fast_of<source, type>();

} // namespace tappet
