// Every small mistake that can be made in a table: each name misspelt, each row dropped or doubled, each type
// changed. The check that runs in the compiler runs here on the changed copies.
#pragma once

#include "tests/diagnostics/copy.hpp"

#include <cstddef>
#include <deque>
#include <functional>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::diagnostics {

/// How the check calls a row.
inline std::string label(const ComponentRow& row) { return "component \"" + std::string{row.name} + "\""; }
inline std::string label(const ActivityRow& row) { return "activity \"" + std::string{row.name} + "\""; }
inline std::string label(const ConnectionRow& row) {
    return "connection \"" + std::string{row.from} + "\" -> \"" + std::string{row.to} + "\"";
}
inline std::string label(const ReactionRow& row) {
    return (row.kind == ReactionKind::uses ? "use \"" : "reaction \"") + std::string{row.event} + "\" -> \"" +
           std::string{row.target.operation} + "\"";
}
inline std::string label(const BehaviourRow& row) {
    return (row.is_slot() ? "slot of \"" : "behaviour of \"") + std::string{row.component} + "\"";
}

struct Tally {
    std::size_t misspelt = 0, dropped = 0, doubled = 0, retyped = 0;
    std::vector<std::string> wrong;          ///< accepted, or another row named
    std::vector<std::string> may_be_dropped; ///< rows without which the table is still good

    [[nodiscard]] std::size_t all() const { return misspelt + dropped + doubled + retyped; }
};

/// Makes every mutation of one table and judges what the check says of it.
class Mutations {
public:
    Mutations(const MachineView& table, const Board& board, const Binding& binding)
        : table_{table}, board_{board}, binding_{binding} {}

    Tally run() {
        misspell_names();
        drop_rows();
        double_rows();
        change_types();
        return tally_;
    }

private:
    /// Refused, and the sentence has one of these in it.
    void expect(std::size_t& count, const std::string& what, const Copy& copy,
                const std::vector<std::string>& named) {
        ++count;
        const std::string refusal = refusal_of(copy.view(), board_, binding_);
        for (const auto& each : named)
            if (refusal.find(each) != std::string::npos) return;
        tally_.wrong.push_back(what + ": " + (refusal.empty() ? "accepted" : refusal));
    }

    // ---- names

    std::string_view keep(std::string text) { return characters_.emplace_back(std::move(text)); }

    /// Each character changed, dropped and doubled.
    std::vector<std::string_view> misspellings(std::string_view name) {
        std::vector<std::string_view> list;
        for (std::size_t i = 0; i < name.size(); ++i) {
            std::string changed{name}, dropped{name}, twice{name};
            changed[i] = name[i] == 'q' ? 'z' : 'q';
            dropped.erase(i, 1);
            twice.insert(i, 1, name[i]);
            list.push_back(keep(changed));
            list.push_back(keep(dropped));
            list.push_back(keep(twice));
        }
        return list;
    }

    /// `place` finds the name in a copy; `named` what the sentence must then have in it.
    void misspell(std::string_view name, const std::function<std::string_view&(Copy&)>& place,
                  const std::function<std::string(const Copy&)>& named) {
        for (const std::string_view wrong : misspellings(name)) {
            Copy copy{table_};
            place(copy) = wrong;
            expect(tally_.misspelt, "\"" + std::string{name} + "\" misspelt \"" + std::string{wrong} + "\"",
                   copy, {named(copy)});
        }
    }

    void misspell_names() {
        for (std::size_t i = 0; i < table_.components.size(); ++i) {
            misspell(
                table_.components[i].name, [i](Copy& c) -> std::string_view& { return c.components[i].name; },
                [i](const Copy& c) { return "\"" + std::string{c.components[i].name} + "\""; });
            if (!table_.components[i].device.empty())
                misspell(
                    table_.components[i].device,
                    [i](Copy& c) -> std::string_view& { return c.components[i].device; },
                    [i](const Copy& c) { return label(c.components[i]); });
            if (!table_.components[i].watched.empty())
                misspell(
                    table_.components[i].watched,
                    [i](Copy& c) -> std::string_view& { return c.components[i].watched; },
                    [i](const Copy& c) { return label(c.components[i]); });
            for (std::size_t s = 0; s < table_.components[i].settings.size(); ++s)
                misspell(
                    table_.components[i].settings[s].name,
                    [i, s](Copy& c) -> std::string_view& { return c.components[i].settings[s].name; },
                    [i](const Copy& c) { return label(c.components[i]); });
        }
        for (std::size_t i = 0; i < table_.activities.size(); ++i) {
            const auto named = [i](const Copy& c) { return label(c.activities[i]); };
            if (table_.activities[i].trigger == Trigger::on_device)
                misspell(
                    table_.activities[i].device,
                    [i](Copy& c) -> std::string_view& { return c.activities[i].device; }, named);
            for (std::size_t n = 0; n < table_.activities[i].runs.size(); ++n)
                misspell(
                    table_.activities[i].runs[n],
                    [i, n](Copy& c) -> std::string_view& { return c.activities[i].runs[n]; }, named);
        }
        for (std::size_t i = 0; i < table_.connections.size(); ++i) {
            const auto named = [i](const Copy& c) { return label(c.connections[i]); };
            misspell(
                table_.connections[i].from,
                [i](Copy& c) -> std::string_view& { return c.connections[i].from; }, named);
            misspell(
                table_.connections[i].to, [i](Copy& c) -> std::string_view& { return c.connections[i].to; },
                named);
        }
        for (std::size_t i = 0; i < table_.reactions.size(); ++i) {
            const auto named = [i](const Copy& c) { return label(c.reactions[i]); };
            misspell(
                table_.reactions[i].event, [i](Copy& c) -> std::string_view& { return c.reactions[i].event; },
                named);
            misspell(
                table_.reactions[i].target.operation,
                [i](Copy& c) -> std::string_view& { return c.reactions[i].target.operation; }, named);
            if (!table_.reactions[i].sent_by.empty())
                misspell(
                    table_.reactions[i].sent_by,
                    [i](Copy& c) -> std::string_view& { return c.reactions[i].sent_by; }, named);
            if (!table_.reactions[i].handle.empty())
                misspell(
                    table_.reactions[i].handle,
                    [i](Copy& c) -> std::string_view& { return c.reactions[i].handle; }, named);
        }
        for (std::size_t i = 0; i < table_.behaviours.size(); ++i) misspell_behaviour(i);
    }

    void misspell_behaviour(std::size_t i) {
        const BehaviourRow& row = table_.behaviours[i];
        const auto named = [i](const Copy& c) { return label(c.behaviours[i]); };
        misspell(
            row.component, [i](Copy& c) -> std::string_view& { return c.behaviours[i].component; }, named);
        for (std::size_t n = 0; n < row.slot.peers.size(); ++n)
            misspell(
                row.slot.peers[n],
                [i, n](Copy& c) -> std::string_view& { return c.behaviours[i].slot.peers[n]; }, named);
        for (std::size_t n = 0; n < row.slot.operations.size(); ++n)
            misspell(
                row.slot.operations[n],
                [i, n](Copy& c) -> std::string_view& { return c.behaviours[i].slot.operations[n]; }, named);
        for (std::size_t n = 0; n < row.slot.events.size(); ++n)
            misspell(
                row.slot.events[n],
                [i, n](Copy& c) -> std::string_view& { return c.behaviours[i].slot.events[n]; }, named);
        // The rows of a state machine are behind a view: a copy of them is kept while its names are misspelt.
        for (std::size_t t = 0; t < row.type.machine.transitions.size(); ++t) {
            const TransitionRow& transition = row.type.machine.transitions[t];
            for (std::string_view TransitionRow::* const part :
                 {&TransitionRow::from, &TransitionRow::to, &TransitionRow::event}) {
                if ((transition.*part).empty()) continue;
                for (const std::string_view wrong : misspellings(transition.*part)) {
                    std::vector<TransitionRow> rows(row.type.machine.transitions.begin(),
                                                    row.type.machine.transitions.end());
                    rows[t].*part = wrong;
                    Copy copy{table_};
                    copy.behaviours[i].type.machine.transitions = rows;
                    expect(tally_.misspelt,
                           "in " + label(row) + " \"" + std::string{transition.*part} + "\" misspelt \"" +
                               std::string{wrong} + "\"",
                           copy, {"\"" + std::string{wrong} + "\""});
                }
            }
        }
        for (std::size_t s = 0; s < row.type.machine.states.size(); ++s) {
            // A state that no row names, like a safe state reached by request alone, has any name.
            if (!is_named(row.type.machine, row.type.machine.states[s].name)) continue;
            for (const std::string_view wrong : misspellings(row.type.machine.states[s].name)) {
                std::vector<StateRow> rows(row.type.machine.states.begin(), row.type.machine.states.end());
                rows[s].name = wrong;
                Copy copy{table_};
                copy.behaviours[i].type.machine.states = rows;
                expect(tally_.misspelt,
                       "state \"" + std::string{row.type.machine.states[s].name} + "\" misspelt \"" +
                           std::string{wrong} + "\"",
                       copy, {"\"" + std::string{wrong} + "\""});
            }
        }
    }

    static bool is_named(const StateMachineTable& machine, std::string_view state) {
        bool named = false;
        for (const auto& each : machine.states) named |= each.parent == state;
        for (const auto& each : machine.transitions) named |= each.from == state || each.to == state;
        return named;
    }

    // ---- rows

    template <class Row>
    void drop(std::vector<Row> Copy::* section,
              const std::function<std::vector<std::string>(const Row&)>& named) {
        const Copy integer{table_};
        for (std::size_t i = 0; i < (integer.*section).size(); ++i) {
            Copy copy{table_};
            (copy.*section).erase((copy.*section).begin() + static_cast<std::ptrdiff_t>(i));
            const Row& row = (integer.*section)[i];
            if (refusal_of(copy.view(), board_, binding_).empty())
                tally_.may_be_dropped.push_back(label(row));
            else
                expect(tally_.dropped, label(row) + " dropped", copy, named(row));
        }
    }
    void drop_rows() {
        drop<ComponentRow>(&Copy::components, [](const ComponentRow& row) {
            return std::vector{"\"" + std::string{row.name} + "\"", "\"" + std::string{row.name} + "."};
        });
        drop<ActivityRow>(&Copy::activities, [](const ActivityRow& row) {
            std::vector<std::string> named{"activity \"" + std::string{row.name} + "\""};
            for (const auto& name : row.runs) named.push_back("component \"" + std::string{name} + "\"");
            return named;
        });
        drop<ConnectionRow>(&Copy::connections, [](const ConnectionRow& row) {
            return std::vector{"\"" + std::string{row.to} + "\""};
        });
        drop<ReactionRow>(&Copy::reactions, [](const ReactionRow& row) {
            // Missed by the operation that is required, by the event that must be heard, or by the call.
            return std::vector{"\"" + std::string{row.target.operation} + "\"",
                               "when(\"" + std::string{row.event} + "\"",
                               "uses(\"" + std::string{row.event} + "\""};
        });
        drop<BehaviourRow>(&Copy::behaviours, [](const BehaviourRow& row) {
            return std::vector{"component \"" + std::string{row.component} + "\""};
        });
    }

    template <class Row> void twice(std::vector<Row> Copy::* section) {
        const Copy integer{table_};
        for (std::size_t i = 0; i < (integer.*section).size(); ++i) {
            Copy copy{table_};
            const Row row = (copy.*section)[i];
            (copy.*section).push_back(row);
            expect(tally_.doubled, label(row) + " doubled", copy, {label(row)});
        }
    }
    void double_rows() {
        twice(&Copy::components);
        twice(&Copy::activities);
        twice(&Copy::connections);
        twice(&Copy::reactions);
        twice(&Copy::behaviours);
    }

    // ---- types

    /// A facet of the same kind as the one at that path, but of another type; empty when the table has none.
    std::string_view of_another_type(std::string_view path) {
        End end;
        if (!resolve(table_, path, FacetKind::input, end).empty()) return {};
        const Facet& facet = facet_at(table_, end);
        for (const auto& row : table_.components)
            for (const auto& other : row.type->facets)
                if (other.kind == facet.kind && other.type != facet.type)
                    return keep(std::string{row.name} + "." + std::string{other.name});
        return {};
    }
    void retype(std::string_view path, const std::function<std::string_view&(Copy&)>& place,
                const std::function<std::string(const Copy&)>& named) {
        const std::string_view other = of_another_type(path);
        if (other.empty()) return;
        Copy copy{table_};
        place(copy) = other;
        expect(tally_.retyped, "\"" + std::string{path} + "\" exchanged for \"" + std::string{other} + "\"",
               copy, {named(copy)});
    }
    void change_types() {
        for (std::size_t i = 0; i < table_.connections.size(); ++i) {
            const auto named = [i](const Copy& c) { return label(c.connections[i]); };
            retype(
                table_.connections[i].from,
                [i](Copy& c) -> std::string_view& { return c.connections[i].from; }, named);
            retype(
                table_.connections[i].to, [i](Copy& c) -> std::string_view& { return c.connections[i].to; },
                named);
        }
        for (std::size_t i = 0; i < table_.reactions.size(); ++i) {
            const auto named = [i](const Copy& c) { return label(c.reactions[i]); };
            retype(
                table_.reactions[i].event, [i](Copy& c) -> std::string_view& { return c.reactions[i].event; },
                named);
            retype(
                table_.reactions[i].target.operation,
                [i](Copy& c) -> std::string_view& { return c.reactions[i].target.operation; }, named);
            if (!table_.reactions[i].handle.empty())
                misspell(
                    table_.reactions[i].handle,
                    [i](Copy& c) -> std::string_view& { return c.reactions[i].handle; }, named);
        }
        for (std::size_t i = 0; i < table_.components.size(); ++i) change_component(i);
    }
    void change_component(std::size_t i) {
        const ComponentRow& row = table_.components[i];
        const std::string name{row.name};
        for (const auto& other : table_.components) {
            if (other.type == row.type) continue;
            Copy copy{table_};
            copy.components[i].type = other.type;
            expect(tally_.retyped, label(row) + " made a " + std::string{other.type->tag->name}, copy,
                   {"\"" + name + "\"", "\"" + name + "."});
        }
        for (std::size_t s = 0; s < row.settings.size(); ++s) {
            Copy copy{table_};
            PropertySetting& setting = copy.components[i].settings[s].setting;
            setting.kind = setting.kind == PropertySetting::Kind::boolean ? PropertySetting::Kind::duration
                                                                          : PropertySetting::Kind::boolean;
            expect(tally_.retyped,
                   label(row) + " with \"" + std::string{row.settings[s].name} + "\" of another type", copy,
                   {label(row)});
        }
    }

    MachineView table_;
    const Board& board_;
    const Binding& binding_;
    std::deque<std::string> characters_; // the misspelt names; a deque's elements stay where they are
    Tally tally_;
};

inline std::ostream& operator<<(std::ostream& out, const Tally& tally) {
    return out << tally.all() << " mutations: " << tally.misspelt << " names misspelt, " << tally.dropped
               << " rows dropped, " << tally.doubled << " rows doubled, " << tally.retyped
               << " types changed; " << tally.wrong.size() << " not refused as they should be, "
               << tally.may_be_dropped.size() << " rows may be dropped";
}

} // namespace tappet::diagnostics
