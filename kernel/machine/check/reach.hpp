// Checks which activities run functions of each component, following the rows, and whether their calls there
// are safe.
#pragma once

#include "kernel/machine/check/events.hpp"
#include "kernel/machine/check/operations.hpp"

namespace tappet::checks {

/// Whether row `i` runs code of its target's component in the caller's activity.
constexpr bool runs_in_caller(const MachineView& m, const TableIndexView& r, std::size_t i) noexcept {
    return m.reactions[i].kind == ReactionKind::when
               ? m.reactions[i].target.synchronous
               : facet_at(m, r.reactions[i].to).kind == FacetKind::method;
}

/// Fills the reach: the activities that run functions of each component, and so may emit its events. These
/// are its own activity and every one that calls its operations and methods without a message.
constexpr void find_reach(const MachineView& m, TableIndexView r) {
    for (std::size_t c = 0; c < m.components.size(); ++c) r.reach[c] = std::uint64_t{1} << r.activity[c];
    bool grown = true;
    for (std::size_t pass = 0; grown && pass < m.components.size(); ++pass) {
        grown = false;
        for (std::size_t i = 0; i < m.reactions.size(); ++i) {
            if (!runs_in_caller(m, r, i)) continue;
            std::uint64_t& reach = r.reach[r.reactions[i].to.component];
            const std::uint64_t more = reach | r.reach[r.reactions[i].from.component];
            grown |= more != reach;
            reach = more;
        }
    }
}

/// Checks calls from one activity into another that the rows do not show: the same activity runs both
/// components of the row, but another activity entered the first one through an operation or a method that is
/// any_thread.
constexpr Sentence check_reach(const MachineView& m, TableIndexView r) {
    if (m.activities.size() >= 64) return {}; // refused by the check of time
    find_reach(m, r);
    for (std::size_t i = 0; i < m.reactions.size(); ++i) {
        if (!runs_in_caller(m, r, i)) continue;
        const ReactionRow& row = m.reactions[i];
        const Link& link = r.reactions[i];
        const std::size_t own = r.activity[link.to.component];
        const bool blocks = m.components[link.to.component].type->work != nullptr;
        for (std::size_t a = 0; a < m.activities.size(); ++a) {
            if (a == own || (r.reach[link.from.component] >> a & 1) == 0) continue;
            const std::string_view from = m.components[link.from.component].name;
            const std::string_view also = m.activities[a].name;
            const Sentence label = row.kind == ReactionKind::when ? of_reaction(row) : of_use(row);
            if (!facet_at(m, link.to).any_thread)
                return Sentence{label,
                                ": activity \"",
                                also,
                                "\" runs functions of \"",
                                from,
                                "\" too, and would call \"",
                                row.target.operation,
                                "\" of activity \"",
                                m.activities[own].name,
                                "\"; ",
                                row.kind == ReactionKind::when ? "use tell(...)" : "make it a command",
                                ", or declare it any_thread if it is safe there"};
            if (blocks && m.activities[a].real_time)
                return Sentence{label,
                                ": component \"",
                                m.components[link.to.component].name,
                                "\" may block, and activity \"",
                                also,
                                "\" runs functions of \"",
                                from,
                                "\" too; ",
                                row.kind == ReactionKind::when ? "use tell(...)" : "make it a command"};
        }
    }
    return {};
}

} // namespace tappet::checks
