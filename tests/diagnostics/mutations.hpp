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
#include <type_traits>
#include <vector>

namespace tappet::diagnostics {

/// The check's name for a row.
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

template <class Row> std::string label_of(const Row& row) { return label(row); }

struct Tally {
    std::size_t misspelt = 0, dropped = 0, doubled = 0, retyped = 0;
    std::vector<std::string> wrong;          ///< accepted, or the sentence names another row
    std::vector<std::string> may_be_dropped; ///< rows without which the table is still good

    [[nodiscard]] std::size_t all() const { return misspelt + dropped + doubled + retyped; }
};

/// Makes every mutation of one table and judges the check's answer to it.
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
    /// Expects a refusal whose sentence contains one of these.
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

    /// `place` finds the name in a row of the section; empty names are skipped. The sentence must contain the
    /// result of `named` for that row.
    template <class Row, class Place>
    void misspell(std::vector<Row> Copy::* section, std::size_t i, Place place,
                  std::string (*named)(const std::type_identity_t<Row>&) = &label_of<Row>) {
        Copy good{table_};
        const std::string_view name = std::invoke(place, (good.*section)[i]);
        for (const std::string_view wrong : misspellings(name)) {
            Copy copy{table_};
            Row& row = (copy.*section)[i];
            std::invoke(place, row) = wrong;
            expect(tally_.misspelt, "\"" + std::string{name} + "\" misspelt \"" + std::string{wrong} + "\"",
                   copy, {named(row)});
        }
    }

    void misspell_names() {
        for (std::size_t i = 0; i < table_.components.size(); ++i) {
            misspell(&Copy::components, i, &ComponentRow::name,
                     [](const ComponentRow& row) { return "\"" + std::string{row.name} + "\""; });
            misspell(&Copy::components, i, &ComponentRow::device);
            misspell(&Copy::components, i, &ComponentRow::watched);
            for (std::size_t s = 0; s < table_.components[i].settings.size(); ++s)
                misspell(&Copy::components, i,
                         [s](ComponentRow& row) -> auto& { return row.settings[s].name; });
        }
        for (std::size_t i = 0; i < table_.activities.size(); ++i) {
            if (table_.activities[i].trigger == Trigger::on_device)
                misspell(&Copy::activities, i, &ActivityRow::device);
            for (std::size_t n = 0; n < table_.activities[i].runs.size(); ++n)
                misspell(&Copy::activities, i, [n](ActivityRow& row) -> auto& { return row.runs[n]; });
        }
        for (std::size_t i = 0; i < table_.connections.size(); ++i) {
            misspell(&Copy::connections, i, &ConnectionRow::from);
            misspell(&Copy::connections, i, &ConnectionRow::to);
        }
        for (std::size_t i = 0; i < table_.reactions.size(); ++i) {
            misspell(&Copy::reactions, i, &ReactionRow::event);
            misspell(&Copy::reactions, i, operation_of);
            misspell(&Copy::reactions, i, &ReactionRow::sent_by);
            misspell(&Copy::reactions, i, &ReactionRow::handle);
        }
        for (std::size_t i = 0; i < table_.behaviours.size(); ++i) misspell_behaviour(i);
    }

    static std::string_view& operation_of(ReactionRow& row) { return row.target.operation; }

    void misspell_behaviour(std::size_t i) {
        const BehaviourRow& row = table_.behaviours[i];
        misspell(&Copy::behaviours, i, &BehaviourRow::component);
        const auto misspell_each = [&](auto Slot::* names) {
            for (std::size_t n = 0; n < (row.slot.*names).size(); ++n)
                misspell(&Copy::behaviours, i,
                         [&](BehaviourRow& each) -> auto& { return (each.slot.*names)[n]; });
        };
        misspell_each(&Slot::peers);
        misspell_each(&Slot::operations);
        misspell_each(&Slot::events);
        // The rows of a state machine are behind a view: a copy of them is kept while its names are misspelt.
        const StateMachineTable& machine = row.type.machine;
        const auto misspell_in = [&](auto StateMachineTable::* section, std::size_t at, auto part) {
            const auto& good = machine.*section;
            for (const std::string_view wrong : misspellings(good[at].*part)) {
                std::vector rows(good.begin(), good.end());
                rows[at].*part = wrong;
                Copy copy{table_};
                copy.behaviours[i].type.machine.*section = rows;
                expect(tally_.misspelt,
                       "in " + label(row) + " \"" + std::string{good[at].*part} + "\" misspelt \"" +
                           std::string{wrong} + "\"",
                       copy, {"\"" + std::string{wrong} + "\""});
            }
        };
        for (std::size_t t = 0; t < machine.transitions.size(); ++t)
            for (std::string_view TransitionRow::* const part :
                 {&TransitionRow::from, &TransitionRow::to, &TransitionRow::event})
                misspell_in(&StateMachineTable::transitions, t, part);
        // A state that no row names, such as a safe state reached only by request, may have any name.
        for (std::size_t s = 0; s < machine.states.size(); ++s)
            if (is_named(machine, machine.states[s].name))
                misspell_in(&StateMachineTable::states, s, &StateRow::name);
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
            // The sentence names the required operation, the event without subscribers, or the call.
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

    /// Returns a facet of the same kind as the one at that path, but of another type; empty: the table has
    /// none.
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
    template <class Row, class Place>
    void retype(std::vector<Row> Copy::* section, std::size_t i, Place place) {
        Copy copy{table_};
        Row& row = (copy.*section)[i];
        const std::string_view path = std::invoke(place, row);
        const std::string_view other = of_another_type(path);
        if (other.empty()) return;
        std::invoke(place, row) = other;
        expect(tally_.retyped, "\"" + std::string{path} + "\" exchanged for \"" + std::string{other} + "\"",
               copy, {label(row)});
    }
    void change_types() {
        for (std::size_t i = 0; i < table_.connections.size(); ++i) {
            retype(&Copy::connections, i, &ConnectionRow::from);
            retype(&Copy::connections, i, &ConnectionRow::to);
        }
        for (std::size_t i = 0; i < table_.reactions.size(); ++i) {
            retype(&Copy::reactions, i, &ReactionRow::event);
            retype(&Copy::reactions, i, operation_of);
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
