// A state machine in constants: order.hpp with every row known at compile time, so that an event and a round
// of a step become a choice between constants. in_memory.hpp continues whatever cannot end here.
#pragma once

#include "kernel/statechart/native_rows.hpp"

namespace tappet {

namespace native {

/// The table that order.hpp uses while a leaf is active; in_memory.hpp has the one for a machine in memory.
template <const auto& source, std::size_t type, StateIndex leaf> struct AtLeaf : MachineRows<source, type> {
    using Rows = MachineRows<source, type>;
    using Execution = Rows::Execution;
    template <StateIndex state> using State = Rows::template State<state>;
    template <ArcIndex arc> using Arc = Rows::template Arc<arc>;
    template <AskedIndex first> using Asked = Rows::template Asked<first>;
    template <StepIndex index, class List> using Step = Rows::template Step<index, List, leaf>;
    static constexpr const ResolvedView& view = Rows::view;
    static constexpr bool is_constant = true;
    static constexpr std::size_t depth = view.plans[leaf].depth;
    template <std::size_t level> using StateAt = State<view.ancestor(leaf, level)>; // from 1

    static constexpr bool takes_at_once(const Execution&) noexcept TAPPET_REALTIME { return true; }
    static constexpr bool is_automatic(const Execution&) noexcept TAPPET_REALTIME { return true; }
    static constexpr bool is_single(const Execution&) noexcept TAPPET_REALTIME { return false; }
    static constexpr void asks_again(const Execution&) noexcept TAPPET_REALTIME {} // none was asked before
    static constexpr void is_done(const Execution&) noexcept TAPPET_REALTIME {}
    static constexpr int no_arc() noexcept TAPPET_REALTIME { return 0; }
    static constexpr StateIndex left_leaf(const Execution&) noexcept TAPPET_REALTIME { return leaf; }
    static constexpr bool has_preconditions(const Execution&) noexcept TAPPET_REALTIME {
        return view.preconditions;
    }
    static constexpr bool lacks_statements(const Execution::Call& call) noexcept TAPPET_REALTIME {
        return Rows::counts && call.left <= 0;
    }
    static constexpr auto conditions() noexcept TAPPET_REALTIME {
        return Asked<view.plans[leaf].conditions>{};
    }

    // ---- guards and preconditions

    template <class Condition>
    [[gnu::always_inline]] static Execution::Answer ask(Execution& e, Condition condition) noexcept
        TAPPET_REALTIME {
        return condition.ask(e);
    }
    template <ArcIndex arc> static ActiveState& source_of(Execution& e, Arc<arc>) noexcept TAPPET_REALTIME {
        return e.status_.states[view.arcs[arc].source_level];
    }
    template <ArcIndex arc>
    [[gnu::always_inline]] static bool captures(Execution& e, Arc<arc>, const std::byte* arguments) noexcept
        TAPPET_REALTIME {
        return Rows::template captures<view.arcs[arc].transition>(e, arguments);
    }
    template <AskedIndex first, class Visit, std::size_t... i>
    [[gnu::always_inline]] static void all_asked([[maybe_unused]] const Visit& visit,
                                                 std::index_sequence<i...>) noexcept TAPPET_REALTIME {
        static_cast<void>(
            ((visit(AtLeaf{}, Arc<view.asked[first + i].arc()>{}) == statechart::Flow::on) && ...));
    }
    template <AskedIndex first, class Visit>
    [[gnu::always_inline]] static void for_each_asked(Execution&, Asked<first>, const Visit& visit) noexcept
        TAPPET_REALTIME {
        all_asked<first>(visit, std::make_index_sequence<Asked<first>::count>{});
    }
    template <ArcIndex arc> static constexpr bool is_asked_from(const Execution&, AtLeaf, Arc<arc>) noexcept
        TAPPET_REALTIME {
        return true;
    }
    template <ArcIndex arc> static constexpr bool is_inside_selected(const Execution&, Arc<arc>) noexcept
        TAPPET_REALTIME {
        return false;
    }
    template <AskedIndex first> static constexpr auto first_asked(const Execution&, Asked<first>,
                                                                  StateIndex) noexcept TAPPET_REALTIME {
        return State<view.arcs[view.asked[first].arc()].source>{};
    }
    template <bool otherwise, ArcIndex arc, class Visit>
    [[gnu::always_inline]] static void for_each_entered(Execution&, Arc<arc>,
                                                        [[maybe_unused]] const Visit& visit) noexcept
        TAPPET_REALTIME {
        if constexpr (view.preconditions) {
            using List = decltype(Arc<arc>::template steps<otherwise>());
            static_cast<void>(for_each_below<List::count>(
                [&]<std::size_t i> [[gnu::always_inline]] () noexcept TAPPET_REALTIME {
                    if constexpr (view.steps[List::first + i].kind == StepKind::place)
                        return visit(State<view.steps[List::first + i].state>{});
                    else
                        return true;
                }));
        }
    }

    // ---- one transition

    // Folds, not closures: the compiler would take each closure apart again, at each of these places.
    template <class Here, class Visit>
    [[gnu::always_inline]] static bool one_step([[maybe_unused]] Execution& e, const Visit& visit) noexcept
        TAPPET_REALTIME {
        constexpr StepKind kind = Here::row().kind;
        const bool has_ended = visit.template operator()<kind>(Here{});
        if constexpr (may_stand(kind))
            if (!has_ended) [[unlikely]] {
                Here::stands(e);
                return false;
            }
        return true;
    }
    template <class List, class Visit, std::size_t... i>
    [[gnu::always_inline]] static bool all_steps([[maybe_unused]] Execution& e,
                                                 [[maybe_unused]] const Visit& visit,
                                                 std::index_sequence<i...>) noexcept TAPPET_REALTIME {
        return (one_step<Step<List::first + i, List>>(e, visit) && ...);
    }
    template <class List, class Visit>
    [[gnu::always_inline]] static bool for_each_step(Execution& e, List, const Visit& visit) noexcept
        TAPPET_REALTIME {
        return all_steps<List>(e, visit, std::make_index_sequence<List::count>{});
    }
    template <std::size_t from, class Visit, std::size_t... i>
    [[gnu::always_inline]] static bool all_states([[maybe_unused]] const Visit& visit,
                                                  std::index_sequence<i...>) noexcept TAPPET_REALTIME {
        return (visit(StateAt<from == 0 ? i + 1 : from - i>{}) && ...);
    }
    template <StepIndex index, class List, class Visit>
    [[gnu::always_inline]] static bool for_each_left(Execution&, Step<index, List>,
                                                     const Visit& visit) noexcept TAPPET_REALTIME {
        return all_states<depth>(visit, std::make_index_sequence<depth - view.steps[index].number>{});
    }
    template <StateIndex state> [[gnu::always_inline]] static void remove(Execution& e, State<state>) noexcept
        TAPPET_REALTIME {
        e.status_.states.used = State<state>::place;
        e.status_.active = view.plans[state].parent;
    }
    template <StepIndex index, class List>
    [[gnu::always_inline]] static void place(Execution& e, Step<index, List>) noexcept TAPPET_REALTIME {
        constexpr StateIndex state = view.steps[index].state;
        ActiveState& at = State<state>::at(e);
        at.state = state;
        at.run = RunPhase::fresh;
        at.entered_at = e.context_.now;
        e.status_.states.used = State<state>::place + 1;
        e.status_.active = state;
    }
    template <StepIndex index, class List>
    static constexpr StateIndex reached(const Execution&, Step<index, List>) noexcept TAPPET_REALTIME {
        return view.steps[index].state != no_state ? view.steps[index].state : leaf;
    }
    template <class Visit>
    [[gnu::always_inline]] static bool for_each_active(Execution&, const Visit& visit) noexcept
        TAPPET_REALTIME {
        return all_states<0>(visit, std::make_index_sequence<depth>{});
    }
};

template <const auto& source, std::size_t type> struct MachineCode : MachineRows<source, type> {
    using Rows = MachineRows<source, type>;
    using Execution = Rows::Execution;
    using Call = Execution::Call;
    static constexpr const ResolvedView& view = Rows::view;
    template <StateIndex leaf> using Order = statechart::Order<AtLeaf<source, type, leaf>>;

    /// One for each cell with something to evaluate, and one for each leaf.
    struct Case {
        std::uint32_t key = 0;
        StateIndex leaf = no_state;
        AskedIndex first = none_asked;
        bool captures = false;
    };
    // Returns the number of cases; stores those that fit, ordered by key.
    template <bool events> static constexpr std::size_t list_cases(std::span<Case> list) {
        std::size_t used = 0;
        for (std::size_t leaf = 0; leaf < view.sizes.states; ++leaf) {
            if (view.plans[leaf].regions != 0) continue;
            const std::size_t keys = events ? view.sizes.triggers : 1;
            for (std::size_t key = leaf * keys; key < (leaf + 1) * keys; ++key) {
                if (events && view.cells[key] == none_asked) continue;
                if (used < list.size())
                    list[used] = {static_cast<std::uint32_t>(key), static_cast<StateIndex>(leaf),
                                  events ? view.cells[key] : none_asked,
                                  events && view.captured[key - leaf * keys] != 0};
                ++used;
            }
        }
        return used;
    }
    template <bool events> static constexpr auto cases = [] {
        std::array<Case, list_cases<events>({})> list{};
        static_cast<void>(list_cases<events>(list));
        return list;
    }();

    struct Event {
        static constexpr bool events = true;
        const std::byte* arguments;
        StateOutcome outcome = StateOutcome::ignored;

        template <std::size_t number> [[gnu::always_inline]] void meets(Execution& e, Call& call) noexcept
            TAPPET_REALTIME {
            constexpr Case at = cases<true>[number];
            if (at.captures && arguments == nullptr) return;
            if (Order<at.leaf>::dispatch(e, typename Rows::template Asked<at.first>{}, arguments, call))
                outcome = StateOutcome::taken;
        }
    };
    struct Round {
        static constexpr bool events = false;
        std::size_t taken = 0;
        bool again = false;

        template <std::size_t number> [[gnu::always_inline]] void meets(Execution& e, Call& call) noexcept
            TAPPET_REALTIME {
            again = Order<cases<false>[number].leaf>::run_round(e, taken, call);
        }
    };
    // Binary search: no table is needed.
    template <class What, std::size_t low, std::size_t high>
    [[gnu::always_inline]] static void chooses(What& what, std::uint32_t key, Execution& e,
                                               Call& call) noexcept TAPPET_REALTIME {
        constexpr const auto& list = cases<What::events>;
        if constexpr (high - low > 1) {
            constexpr std::size_t middle = (low + high) / 2;
            key < list[middle].key ? chooses<What, low, middle>(what, key, e, call)
                                   : chooses<What, middle, high>(what, key, e, call);
        } else if constexpr (low < high) {
            if (key == list[low].key) what.template meets<low>(e, call);
        }
    }

    // For an execution that is ready: nothing waits, nothing is under way.
    static StateOutcome dispatch(Execution& e, std::size_t trigger, Time now,
                                 const std::byte* arguments) noexcept TAPPET_REALTIME {
        if (trigger >= view.sizes.triggers) [[unlikely]]
            return StateOutcome::ignored;
        Call call = e.open_ready(now);
        Event event{arguments};
        chooses<Event, 0, cases<true>.size()>(
            event, static_cast<std::uint32_t>(e.status_.active * view.sizes.triggers + trigger), e, call);
        e.close(call);
        return event.outcome;
    }
    static void step(Execution& e, Time now) noexcept TAPPET_REALTIME {
        Call call = e.open_ready(now);
        e.ran_ = {};
        e.begin_round();
        Round round;
        do chooses<Round, 0, cases<false>.size()>(round, e.status_.active, e, call);
        while (round.again);
        e.close(call);
    }
    static constexpr StateMachineFast fast() noexcept {
        if constexpr (!view.plain)
            return {nullptr, nullptr, &Rows::capture};
        else
            return {&dispatch, &step, &Rows::capture,
                    Rows::counts ? 0 : static_cast<std::uint32_t>(Rows::most_statements)};
    }
};

} // namespace native

/// The compiled form of a constant state machine, for StateMachineBinding::fast. A machine with orthogonal
/// regions or history runs from memory; its programs and conditions are native all the same. `source`: a
/// StateMachine of rows.hpp, or a ScriptUnit with the number of a type; a variable at namespace scope.
template <const auto& source, std::size_t type = 0>
inline constexpr StateMachineFast native_machine = native::MachineCode<source, type>::fast();

} // namespace tappet
