// What the checks found out about a table: indices instead of names. Sized by the table, filled once, read by
// planning.
#pragma once

#include "kernel/machine/names.hpp"

#include <array>
#include <span>

namespace tappet {

struct Link {
    End from;
    End to;
};

/// Which rows of a section end at a component: a chain for each, so that no check compares every row with
/// every other. What was added last comes first.
struct RowsByReceiver {
    std::span<std::size_t> first; ///< of each component
    std::span<std::size_t> next;  ///< of each row

    constexpr void clear() const noexcept {
        for (auto& each : first) each = nowhere;
    }
    constexpr void add(std::size_t row, std::size_t receiver) const noexcept {
        next[row] = first[receiver];
        first[receiver] = row;
    }
};

/// Views into storage of the table's own sizes.
struct TableIndexView {
    std::span<std::size_t> by_name;  ///< the components in the order of their names
    std::span<std::size_t> activity; ///< of each component
    std::span<std::size_t> position; ///< of each component in its activity's data-flow order
    std::span<Link> connections;
    std::span<Link> reactions;
    RowsByReceiver connections_into; ///< whose reader is a component
    RowsByReceiver reactions_into;   ///< whose operation is a component's
    std::span<std::uint64_t> reach;  ///< of each component: a bit for each activity that runs functions of it
    std::span<std::size_t> rank;     ///< of each activity: 0 is the most urgent
    std::span<std::int64_t> worst_response_ns; ///< of each activity; 0 for not_real_time
};

template <std::size_t C, std::size_t A, std::size_t X, std::size_t R> struct TableIndex {
    std::array<std::size_t, C> by_name{};
    std::array<std::size_t, C> activity{};
    std::array<std::size_t, C> position{};
    std::array<Link, X> connections{};
    std::array<Link, R> reactions{};
    std::array<std::size_t, C> first_connection{};
    std::array<std::size_t, X> next_connection{};
    std::array<std::size_t, C> first_reaction{};
    std::array<std::size_t, R> next_reaction{};
    std::array<std::uint64_t, C> reach{};
    std::array<std::size_t, A> rank{};
    std::array<std::int64_t, A> worst_response_ns{};

    constexpr TableIndexView view() noexcept {
        return {by_name,
                activity,
                position,
                connections,
                reactions,
                {first_connection, next_connection},
                {first_reaction, next_reaction},
                reach,
                rank,
                worst_response_ns};
    }
};

} // namespace tappet
