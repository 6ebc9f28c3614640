// A table whose rows can be changed while a program runs, and what the check of the compiler says of it.
#pragma once

#include "kernel/machine/check/check.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::diagnostics {

/// A table whose rows can be changed.
struct Copy {
    std::string_view name;
    std::vector<ComponentRow> components;
    std::vector<ActivityRow> activities;
    std::vector<ConnectionRow> connections;
    std::vector<ReactionRow> reactions;
    std::vector<BehaviourRow> behaviours;

    explicit Copy(const MachineView& m)
        : name{m.name},
          components(m.components.begin(), m.components.end()),
          activities(m.activities.begin(), m.activities.end()),
          connections(m.connections.begin(), m.connections.end()),
          reactions(m.reactions.begin(), m.reactions.end()),
          behaviours(m.behaviours.begin(), m.behaviours.end()) {}

    [[nodiscard]] MachineView view() const {
        return {name, components, activities, connections, reactions, behaviours};
    }
};

/// What the check says of a table; empty: it is accepted.
inline std::string refusal_of(const MachineView& m, const Board& board, const Binding& binding = unbound) {
    const std::size_t components = m.components.size();
    std::vector<std::size_t> by_name(components), activity(components), position(components),
        in_order(components), waits_for(components);
    std::vector<Link> connections(m.connections.size()), reactions(m.reactions.size());
    std::vector<std::size_t> first_into(components), next_into(m.connections.size());
    std::vector<std::size_t> first_from(components), next_from(m.connections.size());
    std::vector<std::size_t> first_reaction(components), next_reaction(m.reactions.size());
    std::vector<std::uint64_t> reach(components);
    std::vector<std::size_t> rank(m.activities.size()), by_rank(m.activities.size());
    std::vector<std::int64_t> worst(m.activities.size());
    return std::string{check(m, board, binding,
                             {.by_name = by_name,
                              .activity = activity,
                              .position = position,
                              .connections = connections,
                              .reactions = reactions,
                              .rank = rank,
                              .by_rank = by_rank,
                              .in_order = in_order,
                              .waits_for = waits_for,
                              .connections_into = {first_into, next_into},
                              .connections_from = {first_from, next_from},
                              .reactions_into = {first_reaction, next_reaction},
                              .reach = reach,
                              .worst_response_ns = worst})
                           .view()};
}

} // namespace tappet::diagnostics
