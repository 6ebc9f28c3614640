// A table whose rows can be changed at run time, and the answer of the compiler's check to it.
#pragma once

#include "kernel/machine/accept.hpp"

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

/// The sentence with which the check refuses a table; empty: it is accepted.
inline std::string refusal_of(const MachineView& m, const Board& board, const Binding& binding = unbound) {
    return std::string{Accepted{m, board, binding}.refusal().view()};
}

} // namespace tappet::diagnostics
