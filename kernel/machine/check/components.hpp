// Checks of the sections components and activities: each component appears once, runs in exactly one
// activity, and has the properties that its row sets.
#pragma once

#include "kernel/activity/engine.hpp"
#include "kernel/machine/check/properties.hpp"

namespace tappet::checks {

/// The number of wakes that the engine remembers to enforce a sporadic activity's limit.
inline constexpr std::int64_t max_wakes_together = Engine::max_wakes_watched;
/// Far above any board's memory, and small enough that the sum of all stacks does not overflow.
inline constexpr std::size_t most_stack_bytes = 1 << 30;

/// Returns the first facet without a name or a doc text, or with the name of an earlier one; nowhere: none.
/// Depends on the type alone, so that a compiler that caches constant calls examines each type once.
constexpr std::size_t faulty_facet(const ComponentType* type) noexcept {
    const auto& facets = type->facets;
    for (std::size_t f = 0; f < facets.size(); ++f) {
        if (facets[f].name.empty() || facets[f].doc.empty()) return f;
        for (std::size_t g = 0; g < f; ++g)
            if (same_text(facets[f].name, facets[g].name)) return f;
    }
    return nowhere;
}

constexpr Sentence check_interface(const ComponentRow& row) {
    const std::size_t faulty = faulty_facet(row.type);
    if (faulty == nowhere) return {};
    const Facet& facet = row.type->facets[faulty];
    // A facet's name may have dots: a table row's path is split at its first dot, after the component.
    if (facet.name.empty())
        return of_component(row.name, ": its interface has a facet without a name; name it in ",
                            row.type->tag->name);
    if (facet.doc.empty())
        return of_component(row.name, ": its facet \"", facet.name, "\" has no description; add one in ",
                            row.type->tag->name);
    return of_component(row.name, ": its interface names \"", facet.name, "\" twice; rename one in ",
                        row.type->tag->name);
}

/// Checks that a mark of motion stands within for_people(..), which offers the facet.
constexpr Sentence check_motion(const ComponentRow& row) {
    for (const Facet& each : row.type->facets)
        if (each.motion != Motion::none && !each.for_people)
            return of_component(
                row.name, ": \"", each.name,
                "\" is marked `moves` but is not for people; write for_people(Role::.., moves), "
                "or remove the mark");
    return {};
}

constexpr Sentence check_life(const ComponentRow& row) {
    const NeverRun& found = row.type->never_run;
    if (found.member.empty()) return {};
    return of_component(row.name, ": ", row.type->tag->name, "::", found.member,
                        " looks like a life-cycle function but would never run; declare it public as \"",
                        found.spelling, "\", or rename it");
}

/// Checks that at most one component records cycles: a tape has one reader, and the worst cycles have one
/// place.
constexpr Sentence check_recorders(const MachineView& m) {
    const ComponentRow* first = nullptr;
    for (const ComponentRow& row : m.components) {
        if (!row.type->records_cycles) continue;
        if (first != nullptr)
            return of_component(row.name, " records the machine's cycles as \"", first->name,
                                "\" does already; remove one of them");
        first = &row;
    }
    return {};
}

/// Checks that each bool output of a driver states its value while stopped: a stopped driver must not keep
/// reporting that its device is well.
constexpr Sentence check_says_at_rest(const ComponentRow& row) {
    if (row.type->device_kind == nullptr) return {};
    for (const Facet& each : row.type->facets)
        if (each.kind == FacetKind::output && each.type == type_id<bool> && each.at_rest == AtRest::unsaid)
            return of_component(row.name, " is a driver, but its output \"", each.name,
                                "\" has no value for a stopped driver; add while_stopped(false), "
                                "while_stopped(true) or as_it_was after its description");
    return {};
}

/// Checks that a driver with a device map says whether its stop() reached the device: the guardian could act
/// by the map, and must know whether it has to.
constexpr Sentence check_says_stopped_safely(const ComponentRow& row) {
    if (row.type->device_map == nullptr || row.type->stop == nullptr || row.type->stopped_safely != nullptr)
        return {};
    return of_component(row.name, " drives a ", row.type->device_kind->name,
                        " device but does not say whether stop() reached it; write bool stopped_safely() "
                        "const noexcept TAPPET_REALTIME, which returns true if nothing is driven");
}

/// Checks that a driver has a device map: start-up opens no device without one.
constexpr Sentence check_has_device_map(const ComponentRow& row) {
    if (row.type->device_kind == nullptr || row.type->device_map != nullptr || row.type->shares_device ||
        row.type->device_kind->is_opened_by_driver)
        return {};
    return of_component(row.name, " drives a ", row.type->device_kind->name,
                        " device but has no device_map, by which start-up opens it; add static constexpr "
                        "auto device_map, as the kind's classes read it, or shares_device = true if another "
                        "component drives the device");
}

/// Checks each component; fills the list by name.
constexpr Sentence check_components(const MachineView& m, const TableIndexView& r) {
    if (m.components.empty())
        return Sentence{"the table has no components; add component<Type>(\"name\") rows to components(...)"};
    for (std::size_t i = 0; i < m.components.size(); ++i) {
        const ComponentRow& row = m.components[i];
        if (row.name.empty() || find_character(row.name, '.') != std::string_view::npos)
            return of_component(row.name, ": a component's name is not empty and has no dot; rename it");
        if (!row.type->device_fault.empty()) return of_component(row.name, ": ", row.type->device_fault);
        if (Sentence fault = check_interface(row); !fault.empty()) return fault;
        if (Sentence fault = check_motion(row); !fault.empty()) return fault;
        if (Sentence fault = check_life(row); !fault.empty()) return fault;
        if (Sentence fault = check_settings(row); !fault.empty()) return fault;
        if (Sentence fault = check_bags(row); !fault.empty()) return fault;
        if (Sentence fault = check_setters(row); !fault.empty()) return fault;
        if (Sentence fault = check_properties_file(m, row); !fault.empty()) return fault;
        if (row.type->device_kind != nullptr && row.device.empty())
            return of_component(row.name, " drives a ", row.type->device_kind->name,
                                " device but its row names none; add device(\"...\")");
        if (row.type->device_kind == nullptr && !row.device.empty())
            return of_component(row.name, " drives no device; remove device(\"", row.device, "\")");
        if (Sentence fault = check_says_at_rest(row); !fault.empty()) return fault;
        if (Sentence fault = check_says_stopped_safely(row); !fault.empty()) return fault;
        if (Sentence fault = check_has_device_map(row); !fault.empty()) return fault;
    }
    if (Sentence fault = check_recorders(m); !fault.empty()) return fault;
    sort_by_name(m, r.by_name);
    for (std::size_t i = 1; i < r.by_name.size(); ++i)
        if (const std::string_view name = m.components[r.by_name[i]].name;
            name == m.components[r.by_name[i - 1]].name)
            return of_component(name, " appears twice in components(...), rows ", r.by_name[i - 1] + 1,
                                " and ", r.by_name[i] + 1, "; rename or remove one");
    return {};
}

/// Returns how many rows of the other sections name a component, in any place.
constexpr std::size_t count_uses(const MachineView& m, std::string_view name) noexcept {
    const auto starts = [name](std::string_view path) {
        return path.size() > name.size() && path[name.size()] == '.' && path.substr(0, name.size()) == name;
    };
    std::size_t uses = 0;
    for (const auto& row : m.activities) {
        uses += row.device == name;
        for (const auto& each : row.runs) uses += each == name;
    }
    for (const auto& row : m.connections) uses += starts(row.from) || starts(row.to);
    for (const auto& row : m.reactions) uses += starts(row.event) || starts(row.target.operation);
    for (const auto& row : m.behaviours) uses += row.component == name;
    return uses;
}

/// Returns the fault of an activity that names an unknown component. When several rows agree on the name and
/// none uses the nearest one, the row in components(...) is misspelt.
constexpr Sentence unknown_to_activity(const MachineView& m, const ActivityRow& row, std::string_view name) {
    Nearest nearest{name};
    for (const auto& each : m.components)
        if (count_uses(m, each.name) == 0) nearest.consider(each.name);
    const std::size_t uses = count_uses(m, name);
    if (nearest.best().empty() || uses < 2) return of_activity(row.name, ": ", unknown_component(m, name));
    return of_component(nearest.best(), " is named in no other row, but ", uses, " rows name \"", name,
                        "\", which is not in components(...); rename it to that");
}

/// Checks the times of an activity, even of one that is not real-time, whose times no analysis uses.
constexpr Sentence check_times(const ActivityRow& row) {
    if (row.at_most_per < Duration::zero())
        return of_activity(row.name, ": the window of at_most is negative; correct at_most(n, per)");
    if (row.at_most_n < 1)
        return of_activity(row.name, ": at_most needs at least one wake; write at_most(1, ...)");
    if (row.at_most_n > max_wakes_together)
        return of_activity(row.name, " promises more than ", max_wakes_together,
                           " wakes in one window; shorten the window of at_most");
    if (row.budget_each < Duration::zero())
        return of_activity(row.name, ": its budget is negative; correct budget(...)");
    if (row.deadline_after < Duration::zero())
        return of_activity(row.name, ": its deadline is negative; correct deadline(...)");
    return {};
}

constexpr Sentence check_trigger(const MachineView& m, const ActivityRow& row) {
    if (!row.twice.empty()) return of_activity(row.name, " has more than one ", row.twice, "; keep one");
    if (!row.has_trigger)
        return of_activity(row.name, ": nothing wakes it; add every(...), on_work() or on_device(\"...\")");
    if (row.too_many_runs)
        return of_activity(row.name, " runs more than ", ActivityRow::max_runs, " components; divide it");
    if (row.runs.empty())
        return of_activity(row.name, " runs no component; add runs(\"...\") or remove the row");
    if (row.periodic() && row.period <= Duration::zero())
        return of_activity(row.name, ": its period is not positive; write every(1ms) or the like");
    if (row.periodic() && (row.phase < Duration::zero() || row.phase >= row.period))
        return of_activity(row.name, ": its phase of ", row.phase.count() / 1000,
                           " us does not lie within its period; write one from 0 us to below ",
                           row.period.count() / 1000, " us");
    if (row.trigger == Trigger::on_device) {
        const std::size_t driver = find_component(m, row.device);
        if (driver == nowhere) return unknown_to_activity(m, row, row.device);
        if (m.components[driver].type->device_kind == nullptr)
            return of_activity(row.name, ": component \"", row.device,
                               "\" drives no device to wake it; name a driver in on_device(...)");
        if (const ComponentType& type = *m.components[driver].type; !type.woken_by_device)
            return of_activity(row.name, ": component \"", row.device, "\" polls its ",
                               type.device_kind->name,
                               " device, which wakes nobody; run it every(...), or let ", type.tag->name,
                               " say woken_by_device = true if its configure() calls Setup::woken_by()");
        bool runs_it = false;
        for (const auto& name : row.runs) runs_it |= name == row.device;
        if (!runs_it)
            return of_activity(row.name, " is woken by the device of \"", row.device,
                               "\" but does not run it; add it to runs(...)");
    }
    if (Sentence fault = check_times(row); !fault.empty()) return fault;
    if (row.real_time) {
        if (row.shortest_period() <= Duration::zero())
            return of_activity(row.name, " does not say how often it may be woken; add at_most(n, per)");
        if (row.budget_each == Duration::zero())
            return of_activity(row.name, " has no budget; add budget(...), or not_real_time");
    }
    if (row.stack_bytes() < 16 * 1024)
        return of_activity(row.name, ": its stack of ", row.stack_bytes(),
                           " bytes is under 16384; enlarge stack(...)");
    if (row.stack_bytes() > most_stack_bytes)
        return of_activity(row.name, ": its stack of ", row.stack_bytes(), " bytes is over ",
                           most_stack_bytes, "; write a smaller stack(...)");
    return {};
}

constexpr Sentence check_loop(const ActivityRow& row, std::string_view name, const ComponentType& type) {
    if (type.loop == nullptr) return {};
    if (type.step != nullptr || type.work != nullptr)
        return of_component(name, " has loop() and also ", type.step != nullptr ? "step()" : "work()",
                            "; keep one of them");
    if (row.real_time)
        return of_activity(row.name, " is real-time but component \"", name,
                           "\" may block (it has loop()); run it in an activity that is not_real_time");
    if (row.periodic())
        return of_activity(row.name, " is periodic but component \"", name,
                           "\" decides itself when it runs (it has loop()); run it on_work()");
    if (row.runs.size() != 1)
        return of_activity(row.name, " runs others beside component \"", name,
                           "\", which keeps the thread (it has loop()); run it in an activity of its own");
    return {};
}

/// Checks that the activity is as fast as a value of its map, "comes_every": a map's period that the activity
/// does not keep is a promise without effect.
constexpr Sentence check_outside(const ActivityRow& row, const ComponentRow& component, const Facet& facet) {
    const bool is_on_device = row.trigger == Trigger::on_device;
    const bool is_woken = component.type->woken_by_device;
    if (facet.comes_every == Duration::zero() || (is_on_device && is_woken)) return {};
    if (!row.periodic())
        return of_activity(row.name, is_on_device ? " runs on_device(\"" : " runs on_work(", row.device,
                           is_on_device ? "\"), but \"" : "), but \"", component.name, ".", facet.name,
                           "\" crosses the wire every ", facet.comes_every.count() / 1000,
                           " us by its map, which wakes nobody; run it every(...)",
                           !is_on_device && (is_woken || component.type->device_kind == nullptr)
                               ? " or on_device(...)"
                               : "");
    if (row.period <= facet.comes_every) return {};
    return of_activity(
        row.name, " runs every ", row.period.count() / 1000, " us, but \"", component.name, ".", facet.name,
        "\" crosses the wire every ", facet.comes_every.count() / 1000,
        " us by its map; shorten the activity's period, or lengthen the every(...) of the map");
}

/// Checks that a periodic activity is as fast as what its driver's map lets cross, also on demand and without
/// a value.
constexpr Sentence check_pace(const ActivityRow& row, const ComponentRow& component) {
    const DevicePace& pace = component.type->device_pace;
    if (!row.periodic() || pace.apart == Duration::zero() || row.period <= pace.apart) return {};
    return of_activity(row.name, " runs every ", row.period.count() / 1000, " us, but \"", component.name,
                       ".", pace.name, "\" may cross the wire every ", pace.apart.count() / 1000,
                       " us by its map; shorten the activity's period, or lengthen the every(...) or "
                       "on_demand(...) of the map");
}

/// Checks each activity; fills the activity of each component.
constexpr Sentence check_activities(const MachineView& m, TableIndexView r) {
    for (auto& each : r.activity) each = nowhere;
    for (std::size_t a = 0; a < m.activities.size(); ++a) {
        const ActivityRow& row = m.activities[a];
        for (std::size_t j = 0; j < a; ++j)
            if (m.activities[j].name == row.name)
                return of_activity(row.name, " appears twice in activities(...), rows ", j + 1, " and ",
                                   a + 1, "; rename or remove one");
        if (Sentence fault = check_trigger(m, row); !fault.empty()) return fault;
        for (const auto& name : row.runs) {
            const std::size_t c = find_component(m, r.by_name, name);
            if (c == nowhere) return unknown_to_activity(m, row, name);
            if (r.activity[c] == a)
                return of_component(name, " is run twice by activity \"", row.name, "\"; remove it once");
            if (r.activity[c] != nowhere)
                return of_component(name, " is run by activity \"", m.activities[r.activity[c]].name,
                                    "\" and by activity \"", row.name, "\"; keep it in one");
            r.activity[c] = a;
            for (const auto& facet : m.components[c].type->facets) {
                if (Sentence fault = check_outside(row, m.components[c], facet); !fault.empty()) return fault;
                if (facet.kind == FacetKind::timer && row.real_time && row.periodic())
                    return of_activity(row.name, " is periodic but component \"", name, "\" has the timer \"",
                                       facet.name,
                                       "\", which runs between periods; run it on_work() with at_most(n, "
                                       "per), so that the analysis counts it");
            }
            if (Sentence fault = check_pace(row, m.components[c]); !fault.empty()) return fault;
            if (Sentence fault = check_loop(row, name, *m.components[c].type); !fault.empty()) return fault;
            if (m.components[c].type->work != nullptr && row.real_time)
                return of_activity(
                    row.name, " is real-time but component \"", name,
                    "\" may block (it has work()); run it in an activity that is not_real_time");
        }
    }
    for (std::size_t c = 0; c < m.components.size(); ++c)
        if (r.activity[c] == nowhere)
            return of_component(m.components[c].name, ": no activity runs it; add it to runs(...) of one");
    return {};
}

/// Whether a section of the table ensures that two components never run at the same time: two writers of one
/// input, or two answerers of one call.
constexpr bool take_turns(const MachineView& m, std::size_t one, std::size_t other) {
    for (std::size_t e = 0; e < m.extras->size(); ++e)
        if (m.extras->at(e)->take_turns(m, one, other)) return true;
    return false;
}

} // namespace tappet::checks
