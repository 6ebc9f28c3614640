// Checks of the targets of watchdogs: the target exists, lives by itself, and runs in another activity.
#pragma once

#include "kernel/machine/check/components.hpp"

namespace tappet::checks {

/// Returns the limit that the row sets; zero: the component's own.
constexpr Duration limit_of(const ComponentRow& row) noexcept {
    for (const PropertyRow& setting : row.settings)
        if (setting.name == "limit") return Duration{setting.setting.integer};
    return Duration::zero();
}

constexpr Sentence check_watched_activity(const MachineView& m, const ComponentRow& row,
                                          std::size_t watched) {
    const ActivityRow& activity = m.activities[watched];
    const Duration limit = limit_of(row);
    if (limit <= Duration::zero())
        return of_component(row.name, " watches activity \"", activity.name,
                            "\" without a limit; add set(\"limit\", ...) longer than its period");
    if (activity.periodic() && limit <= activity.period)
        return of_component(row.name, " watches activity \"", activity.name, "\" with a limit of ",
                            limit.count() / 1000, " us, not longer than its period of ",
                            activity.period.count() / 1000, " us; lengthen the limit");
    return {};
}

/// Checks a watched output; needs the ends of the connections.
constexpr Sentence check_watched_output(const MachineView& m, TableIndexView r, const ComponentRow& row,
                                        End output) {
    if (facet_at(m, output).kind != FacetKind::output)
        return of_component(row.name, " watches \"", row.watched, "\", which is ",
                            to_text(facet_at(m, output).kind),
                            "; name an activity, or an output of last values");
    const std::size_t writer = r.activity[output.component];
    for (std::size_t x = 0; x < m.connections.size(); ++x)
        if (r.connections[x].from == output && r.activity[r.connections[x].to.component] != writer) return {};
    return of_component(
        row.name, " watches \"", row.watched,
        "\", which no connection carries to another activity; connect it there, or watch activity \"",
        m.activities[writer].name, "\"");
}

constexpr Sentence check_watches(const MachineView& m, TableIndexView r) {
    for (std::size_t c = 0; c < m.components.size(); ++c) {
        const ComponentRow& row = m.components[c];
        if (!row.type->watches_life) {
            if (!row.watched.empty())
                return of_component(row.name, " is not a watchdog; remove watches(\"", row.watched, "\")");
            continue;
        }
        if (row.watched.empty())
            return of_component(row.name,
                                " watches nothing; add watches(\"...\") with an activity or an output");
        const ActivityRow& own = m.activities[r.activity[c]];
        if (!own.periodic())
            return of_component(row.name, " checks once in each cycle, but activity \"", own.name,
                                "\" may never be woken; run it in a periodic activity, every(...)");
        std::size_t watched = find_activity(m, row.watched);
        if (watched != nowhere) {
            if (Sentence fault = check_watched_activity(m, row, watched); !fault.empty()) return fault;
        } else if (row.watched.find('.') == std::string_view::npos) {
            Nearest nearest{row.watched};
            for (const auto& each : m.activities) nearest.consider(each.name);
            Sentence text =
                of_component(row.name, " watches \"", row.watched, "\", but no activity has this name");
            detail::add_suggestion(text, nearest, "name an activity, or an output as component.output");
            return text;
        } else {
            End output;
            if (Sentence fault = resolve(m, r.by_name, row.watched, FacetKind::output, output);
                !fault.empty())
                return of_component(row.name, " watches \"", row.watched, "\": ", fault);
            if (Sentence fault = check_watched_output(m, r, row, output); !fault.empty()) return fault;
            watched = r.activity[output.component];
        }
        if (watched == r.activity[c])
            return of_component(
                row.name, " runs in activity \"", own.name,
                "\", which it watches, and would fall silent with it; run it in another activity");
    }
    return {};
}

} // namespace tappet::checks
