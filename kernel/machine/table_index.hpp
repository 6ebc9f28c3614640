// What the checks found out about a table: indices instead of names. Sized by the table, filled once, read by planning.
#pragma once

#include "kernel/machine/names.hpp"

#include <array>
#include <span>

namespace tappet {

struct Link {
    End from;
    End to;
};

/// Views into storage of the table's own sizes.
struct TableIndexView {
    std::span<std::size_t> activity;      ///< of each component
    std::span<std::size_t> position;      ///< of each component in its activity's data-flow order
    std::span<Link> connections;
    std::span<Link> reactions;
    std::span<std::size_t> rank;          ///< of each activity: 0 is the most urgent
    std::span<std::int64_t> worst_response_ns; ///< of each activity; 0 for not_real_time
};

template <std::size_t C, std::size_t A, std::size_t X, std::size_t R>
struct TableIndex {
    std::array<std::size_t, C> activity{};
    std::array<std::size_t, C> position{};
    std::array<Link, X> connections{};
    std::array<Link, R> reactions{};
    std::array<std::size_t, A> rank{};
    std::array<std::int64_t, A> worst_response_ns{};

    constexpr TableIndexView view() noexcept { return {activity, position, connections, reactions, rank, worst_response_ns}; }
};

} // namespace tappet
