// Checks of components that control another one: the target exists, and a task runs in the activity of its
// behaviour.
#pragma once

#include "kernel/machine/check/behaviours.hpp"

namespace tappet::checks {

/// Returns the behaviour row that a task controls; nowhere: none. A row compiled from the task's own script
/// takes precedence over a slot; a task without a script controls any row that drives the component.
constexpr std::size_t controlled_behaviour(const MachineView& m, const ComponentRow& task) {
    const ScriptUnit* const script = task.type->script;
    std::size_t found = nowhere;
    for (std::size_t b = 0; b < m.behaviours.size(); ++b) {
        const BehaviourRow& row = m.behaviours[b];
        if (row.component != task.controlled) continue;
        const bool is_its_own =
            !row.is_slot() && (script == nullptr || row.unit().instances.data() == script->instances.data());
        if (found == nowhere || is_its_own || (row.is_slot() && script != nullptr)) found = b;
        if (is_its_own) break;
    }
    return found;
}
/// Returns the number of the instance in a compiled unit; nowhere: none.
constexpr std::size_t controlled_instance(const ScriptUnit& unit, const ComponentRow& task) {
    if (task.type->instance.empty()) return 0;
    for (std::size_t i = 0; i < unit.instances.size(); ++i)
        if (unit.instances[i].name == task.type->instance) return i;
    return nowhere;
}

constexpr Sentence check_task(const MachineView& m, const TableIndexView& r, std::size_t c) {
    const ComponentRow& task = m.components[c];
    const std::size_t b = controlled_behaviour(m, task);
    if (b == nowhere)
        return of_component(task.name, " controls \"", task.controlled,
                            "\", which no behaviour drives; add behaviour(\"", task.controlled,
                            "\", ...) to behaviours(...)");
    const BehaviourRow& row = m.behaviours[b];
    const ScriptUnit unit = row.is_slot() && task.type->script != nullptr ? *task.type->script : row.unit();
    if (task.type->script != nullptr && unit.instances.data() != task.type->script->instances.data())
        return of_component(task.name, " is a task of script \"", task.type->script->name, "\" but \"",
                            row.component, "\" is driven by \"", unit.name,
                            "\"; make it BehaviourTask<...> of that script");
    if (controlled_instance(unit, task) == nowhere) {
        Nearest nearest{task.type->instance};
        for (const BehaviourInstance& each : unit.instances) nearest.consider(each.name);
        Sentence text = of_component(task.name, " is the task of \"", task.type->instance,
                                     "\", which script \"", unit.name, "\" does not have");
        detail::add_suggestion(text, nearest, "name one of its programs or state machines");
        return text;
    }
    const std::size_t activity = r.activity[find_component(m, row.component)];
    if (r.activity[c] != activity)
        return of_component(task.name, " controls the behaviour of \"", row.component,
                            "\", which activity \"", m.activities[activity].name,
                            "\" runs; run both in that one");
    return {};
}

constexpr Sentence check_controls(const MachineView& m, const TableIndexView& r) {
    using Controls = ComponentType::Controls;
    for (std::size_t c = 0; c < m.components.size(); ++c) {
        const ComponentRow& row = m.components[c];
        if (row.type->controls == Controls::nothing) {
            if (!row.controlled.empty())
                return of_component(row.name, " cannot control another component; remove controls(\"",
                                    row.controlled, "\"), or make it a BehaviourTask or a ComponentLife");
            continue;
        }
        if (row.controlled.empty())
            return of_component(row.name, " controls nothing; add controls(\"...\") with a component");
        const std::size_t controlled = find_component(m, row.controlled);
        if (controlled == nowhere)
            return of_component(row.name, " controls \"", row.controlled,
                                "\": ", unknown_component(m, row.controlled));
        if (controlled == c) return of_component(row.name, " controls itself; name another component");
        if (row.type->controls == Controls::life) {
            if (const ActivityRow& own = m.activities[r.activity[c]]; !own.periodic())
                return of_component(row.name, " polls for the answer once in each cycle, but activity \"",
                                    own.name,
                                    "\" may never be woken; run it in a periodic activity, every(...)");
            continue;
        }
        if (Sentence fault = check_task(m, r, c); !fault.empty()) return fault;
    }
    return {};
}

} // namespace tappet::checks
