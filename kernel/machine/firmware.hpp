// A machine, bound to a board: the compiler checks and plans the table and gives it its memory. A table that
// cannot work does not compile; the first error is one sentence that names the row, the fault and the cure.
#pragma once

#include "kernel/machine/map/map.hpp"
#include "kernel/machine/plan/plan.hpp"

namespace tappet {

/// The verdict on a table: the sentence, and the results of the checks.
template <std::size_t C, std::size_t A, std::size_t X, std::size_t R>
struct Verdict {
    TableIndex<C, A, X, R> index{};
    Sentence refusal{};
};

template <std::size_t C, std::size_t A, std::size_t X, std::size_t R, std::size_t B, class... E>
constexpr Verdict<C, A, X, R> judge(const Machine<C, A, X, R, B, E...>& table, const Board& board,
                                    const Binding& binding = unbound) {
    Verdict<C, A, X, R> verdict;
    verdict.refusal = check(table.view(), board, binding, verdict.index.view());
    return verdict;
}

template <std::size_t S, std::size_t C, std::size_t A, std::size_t X, std::size_t R, std::size_t B,
          class... E>
constexpr Plan<C, A, X, S, B> plan_for(const Machine<C, A, X, R, B, E...>& table, const Board& board,
                                       const Binding& binding, TableIndex<C, A, X, R> index,
                                       std::size_t map_bytes) {
    Plan<C, A, X, S, B> plan;
    PlanView view = plan.view();
    make_plan(table.view(), board, binding, index.view(), map_bytes, view);
    static_cast<PlanOfAll&>(plan) = view;
    return plan;
}

namespace detail {

template <const auto& table, const Board& board, const Binding& binding>
struct Judged {
    static constexpr auto verdict = judge(table, board, binding);
};

template <const auto& table, const Board& board, const Binding& binding, bool observed>
struct Mapped {
    static constexpr std::size_t bytes = 0;
    static std::span<const std::byte> map() { return {}; }
    static std::span<const TypeId> types() { return {}; }
};

template <const auto& table, const Board& board, const Binding& binding>
struct Mapped<table, board, binding, true> {
    static constexpr map::Counts counts = [] {
        auto index = Judged<table, board, binding>::verdict.index;
        return map::count(table.view(), board, binding, index.view());
    }();
    static constexpr auto drawn = [] {
        auto index = Judged<table, board, binding>::verdict.index;
        return map::draw<counts>(table.view(), board, binding, index.view());
    }();
    static constexpr std::size_t bytes = sizeof drawn.map;
    static_assert(drawn.map.header.map_bytes == bytes, "no gap stands between the map's sections");
    static std::span<const std::byte> map() { return std::as_bytes(std::span{&drawn.map, 1}); }
    static std::span<const TypeId> types() { return {drawn.types.data(), counts.types}; }
};

template <const auto& table, const Board& board, const Binding& binding, bool good>
struct Planned {
    static constexpr Sentence refusal = Judged<table, board, binding>::verdict.refusal;
};

template <const auto& table, const Board& board, const Binding& binding>
struct Planned<table, board, binding, true> {
    static constexpr auto& verdict = Judged<table, board, binding>::verdict;
    using Map = Mapped<table, board, binding, find_observer(table.view()) != nowhere>;
    static constexpr auto plan =
        plan_for<count_subscriptions(table.view())>(table, board, binding, verdict.index, Map::bytes);
    static constexpr Sentence refusal =
        check_plan(table.view(), board, plan.subscriptions, plan.bytes, plan.stack_bytes);
};

template <const auto& table, const Board& board, const Binding& binding, bool good>
struct Instance {
    static AcceptedMachine machine(const MachineView&) { return {}; }
};

template <const auto& table, const Board& board, const Binding& binding>
struct Instance<table, board, binding, true> {
    using From = Planned<table, board, binding, true>;
    // Start-up reads these through spans of mutable elements and does not write them.
    static inline constinit auto index = From::verdict.index.kept;
    static inline constinit auto plan = From::plan;
    [[gnu::section(".bss.tappet_instance")]] alignas(
        4096) static inline constinit std::byte memory[From::plan.bytes]{};

    static AcceptedMachine machine(const MachineView& view) {
        return {view,        &board, &binding,         index.view(),
                plan.view(), memory, From::Map::map(), From::Map::types()};
    }
};

} // namespace detail

/// `table`, `board` and `binding` are constexpr variables at namespace scope:
///     using LoomFirmware = tappet::Firmware<carpet_loom, board, binding>;
template <const auto& table, const Board& board, const Binding& binding = unbound>
struct Firmware {
    static constexpr bool sound = detail::Judged<table, board, binding>::verdict.refusal.empty();
    static constexpr const Sentence& refusal = detail::Planned<table, board, binding, sound>::refusal;
    static constexpr bool accepted = refusal.empty();
    // Not TAPPET_ACCEPTED: a macro of another header makes g++ say twice as much.
#if defined(__clang__)
    static_assert(accepted, refusal);
#else
    static_assert(refused<text<refusal.size()>{refusal.view()}>::accepted);
#endif

    static AcceptedMachine machine() { return machine(table.view()); }
    /// `view` is that of the table. A view from another object file saves this file the code of all
    /// components, to which the rows lead.
    static AcceptedMachine machine(const MachineView& view) {
        return detail::Instance<table, board, binding, accepted>::machine(view);
    }

    /// The machine's map (thesis 4.7.2) as a constant: map::Storage. Available for any accepted table, even
    /// when no component sees the machine.
    template <bool good = accepted>
    static constexpr const auto& map() {
        return detail::Mapped<table, board, binding, good>::drawn.map;
    }
};

} // namespace tappet
