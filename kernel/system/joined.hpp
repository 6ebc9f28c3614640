// Appends rows to one machine's table: the form of a node in its system.
#pragma once

#include "kernel/system/resolve.hpp"

namespace tappet::systems {

template <class T, std::size_t A, std::size_t B>
constexpr std::array<T, A + B> both(const std::array<T, A>& first, const std::array<T, B>& then) {
    std::array<T, A + B> all{};
    std::copy(then.begin(), then.end(), std::copy(first.begin(), first.end(), all.begin()));
    return all;
}

template <std::size_t C, std::size_t A, std::size_t X, std::size_t R, std::size_t B, class... Extra,
          std::size_t C2, std::size_t A2, std::size_t X2, std::size_t R2>
constexpr Machine<C + C2, A + A2, X + X2, R + R2, B, Extra...>
joined(std::string_view name, const Machine<C, A, X, R, B, Extra...>& table,
       const std::array<ComponentRow, C2>& components, const std::array<ActivityRow, A2>& activities,
       const std::array<ConnectionRow, X2>& connections, const std::array<ReactionRow, R2>& reactions) {
    return {name,
            both(table.components, components),
            both(table.activities, activities),
            both(table.connections, connections),
            both(table.reactions, reactions),
            table.behaviours,
            table.extras};
}

} // namespace tappet::systems
