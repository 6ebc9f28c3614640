// Results of the checks of a table: indices instead of names. Sized by the table, filled once, read by
// planning.
#pragma once

#include "kernel/machine/table/names.hpp"

#include <array>
#include <span>

namespace tappet {

struct Link {
    End from;
    End to;
};

/// Lists, as one chain for each component, the rows of a section that begin, or end, at it, so that no check
/// compares every row with every other. The row added last comes first.
struct RowsByComponent {
    std::span<std::size_t> first; ///< of each component
    std::span<std::size_t> next;  ///< of each row

    constexpr void clear() const noexcept {
        for (auto& each : first) each = nowhere;
    }
    constexpr void add(std::size_t row, std::size_t component) const noexcept {
        next[row] = first[component];
        first[component] = row;
    }
};

/// Views into storage of the table's sizes. A running machine keeps only the first part; the rest is empty.
struct TableIndexView {
    std::span<std::size_t> by_name;  ///< the components in the order of their names
    std::span<std::size_t> activity; ///< of each component
    std::span<std::size_t> position; ///< of each component in its activity's data-flow order
    std::span<Link> connections;
    std::span<Link> reactions;
    std::span<std::size_t> rank; ///< of each activity: 0 is the most urgent

    std::span<std::size_t> by_rank;   ///< the activities, the most urgent first
    std::span<std::size_t> in_order;  ///< the components, activity by activity, each in its data-flow order
    std::span<std::size_t> waits_for; ///< of each component: rows it waits for, during ordering
    RowsByComponent connections_into; ///< rows whose reader is the component
    RowsByComponent connections_from; ///< rows whose writer is the component
    RowsByComponent reactions_into;   ///< rows whose operation belongs to the component
    std::span<std::uint64_t> reach; ///< of each component: a bit for each activity that runs functions of it
    std::span<bool> acts;           ///< of each component: it may emit, write or call; see check/wakes.hpp
    std::span<std::int64_t> worst_response_ns; ///< of each activity; 0 for not_real_time
};

/// The part that start-up and a running machine read.
template <std::size_t C, std::size_t A, std::size_t X, std::size_t R> struct KeptIndex {
    std::array<std::size_t, C> by_name{};
    std::array<std::size_t, C> activity{};
    std::array<std::size_t, C> position{};
    std::array<Link, X> connections{};
    std::array<Link, R> reactions{};
    std::array<std::size_t, A> rank{};

    constexpr TableIndexView view() noexcept {
        TableIndexView view;
        view.by_name = by_name;
        view.activity = activity;
        view.position = position;
        view.connections = connections;
        view.reactions = reactions;
        view.rank = rank;
        return view;
    }
};

template <std::size_t C, std::size_t A, std::size_t X, std::size_t R> struct TableIndex {
    KeptIndex<C, A, X, R> kept{};
    std::array<std::size_t, A> by_rank{};
    std::array<std::size_t, C> in_order{};
    std::array<std::size_t, C> waits_for{};
    std::array<std::size_t, C> first_connection_into{};
    std::array<std::size_t, X> next_connection_into{};
    std::array<std::size_t, C> first_connection_from{};
    std::array<std::size_t, X> next_connection_from{};
    std::array<std::size_t, C> first_reaction{};
    std::array<std::size_t, R> next_reaction{};
    std::array<std::uint64_t, C> reach{};
    std::array<bool, C> acts{};
    std::array<std::int64_t, A> worst_response_ns{};

    constexpr TableIndexView view() noexcept {
        TableIndexView view = kept.view();
        view.by_rank = by_rank;
        view.in_order = in_order;
        view.waits_for = waits_for;
        view.connections_into = {first_connection_into, next_connection_into};
        view.connections_from = {first_connection_from, next_connection_from};
        view.reactions_into = {first_reaction, next_reaction};
        view.reach = reach;
        view.acts = acts;
        view.worst_response_ns = worst_response_ns;
        return view;
    }
};

} // namespace tappet
