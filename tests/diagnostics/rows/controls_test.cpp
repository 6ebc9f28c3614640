// Components that control others: the tasks of behaviours, and the lives of components.
#include "kernel/machine/table/compiled.hpp"
#include "kernel/script/compiled.hpp"
#include "kernel/services/tasks/behaviour_task.hpp"
#include "kernel/services/tasks/component_life.hpp"
#include "tests/diagnostics/rows/fault.hpp"
#include "tests/diagnostics/small_machine.hpp"

namespace {

using namespace small;
using namespace tappet::diagnostics;

constexpr ScriptSource weaving_source{"weaving.osd", "program feed(int picks) { yield; }"};
constexpr auto weft_reach = script_reach(reachable<Weft>("weft"));
constexpr const ScriptUnit& weaving = compiled_script<weaving_source, weft_reach>;
constexpr ScriptSource other_source{"other.osd", "program feed(int picks) { yield; }"};
constexpr const ScriptUnit& other = compiled_script<other_source, weft_reach>;

// Facets that the script may reach and that the machine declares differently.
constexpr ScriptSource lifting_source{"lifting.osd", "program lift(int picks) { yield; }"};
constexpr auto unknown_reach = script_reach(reachable<Weft>("weft"), reachable<Lamps>("lanterns", false));
constexpr const ScriptUnit& with_unknown_peer = compiled_script<lifting_source, unknown_reach>;
constexpr auto other_reach = script_reach(reachable<Weft>("weft"), reachable<Encoder>("lamps", false));
constexpr const ScriptUnit& with_other_peer = compiled_script<lifting_source, other_reach>;
constexpr auto near_reach = script_reach(reachable<Weft>("weft"), reachable<Shaft>("shaft"));
constexpr const ScriptUnit& with_near_peer = compiled_script<lifting_source, near_reach>;
constexpr ScriptUnit empty_script{.name = "empty.osd"};

constexpr Fault script_faults[] = {
    {"script_peer_unknown", [](Table& m) { m.behaviours[0] = behaviour("weft", with_unknown_peer, {}); },
     R"(loom: behaviour of "weft": script "lifting.osd": its reach: there is no component "lanterns"; add it to components(...))"},
    {"script_peer_of_another_type",
     [](Table& m) { m.behaviours[0] = behaviour("weft", with_other_peer, {}); },
     R"(loom: behaviour of "weft": script "lifting.osd" was compiled for small::Encoder but "lamps" is a small::Lamps; give its reach that type)"},
    {"script_peer_elsewhere", [](Table& m) { m.behaviours[0] = behaviour("weft", with_near_peer, {}); },
     R"(loom: behaviour of "weft": script "lifting.osd" uses "shaft" as a component of its own activity, but activity "motion" runs it; compile it with a reach that says so, or run both in one activity)"},
    {"script_with_nothing_to_run", [](Table& m) { m.behaviours[0] = behaviour("weft", empty_script, {}); },
     R"(loom: behaviour of "weft": script "empty.osd" has nothing to run; add a RootStateMachine or a program)"},
};
INSTANTIATE_TEST_SUITE_P(scripts, Refusal, planted_into(small_loom, script_faults), name_of);

Table controlled_loom() {
    Table m = small_loom();
    m.add(component<BehaviourTask<weaving, "feed">>("feeding", controls("weft")));
    m.add(component<ComponentLife>("lighting", controls("lamps")));
    m.put(activity("logic", on_work(), at_most(8, 4ms), deadline(2ms), budget(30us),
                   runs("weft", "lamps", "feeding")));
    m.add(activity("light", every(10ms), not_real_time, runs("lighting")));
    m.behaviours[0] = behaviour("weft", weaving, {});
    return m;
}

constexpr Fault control_faults[] = {
    {"control_of_nothing", [](Table& m) { m.put(component<ComponentLife>("lighting")); },
     R"(loom: component "lighting" controls nothing; add controls("...") with a component)"},
    {"control_by_another", [](Table& m) { m.put(component<Weft>("weft", controls("lamps"))); },
     R"(loom: component "weft" cannot control another component; remove controls("lamps"), or make it a BehaviourTask or a ComponentLife)"},
    {"control_of_an_unknown_component",
     [](Table& m) { m.put(component<ComponentLife>("lighting", controls("lamp"))); },
     R"(loom: component "lighting" controls "lamp": there is no component "lamp"; did you mean "lamps"?)"},
    {"control_of_itself", [](Table& m) { m.put(component<ComponentLife>("lighting", controls("lighting"))); },
     R"(loom: component "lighting" controls itself; name another component)"},
    {"life_that_may_sleep",
     [](Table& m) { m.put(activity("light", on_work(), not_real_time, runs("lighting"))); },
     R"(loom: component "lighting" polls for the answer once in each cycle, but activity "light" may never be woken; run it in a periodic activity, every(...))"},
    {"task_of_what_has_no_behaviour",
     [](Table& m) { m.put(component<BehaviourTask<>>("feeding", controls("lamps"))); },
     R"(loom: component "feeding" controls "lamps", which no behaviour drives; add behaviour("lamps", ...) to behaviours(...))"},
    {"task_of_an_unknown_program_of_a_slot",
     [](Table& m) {
         m.add(behaviour("lamps", slot(nodes(20), data_bytes(100), depth(1))));
         m.put(component<BehaviourTask<weaving, "fed">>("feeding", controls("lamps")));
     },
     R"(loom: component "feeding" is the task of "fed", which script "weaving.osd" does not have; did you mean "feed"?)"},
    {"task_of_another_script", [](Table& m) { m.behaviours[0] = behaviour("weft", other, {}); },
     R"(loom: component "feeding" is a task of script "weaving.osd" but "weft" is driven by "other.osd"; make it BehaviourTask<...> of that script)"},
    {"task_of_an_unknown_program",
     [](Table& m) { m.put(component<BehaviourTask<weaving, "fed">>("feeding", controls("weft"))); },
     R"(loom: component "feeding" is the task of "fed", which script "weaving.osd" does not have; did you mean "feed"?)"},
    {"task_of_no_program",
     [](Table& m) { m.put(component<BehaviourTask<weaving, "thunder">>("feeding", controls("weft"))); },
     R"(loom: component "feeding" is the task of "thunder", which script "weaving.osd" does not have; name one of its programs or state machines)"},
    {"task_in_another_activity",
     [](Table& m) {
         m.put(activity("logic", on_work(), at_most(8, 4ms), deadline(2ms), budget(30us),
                        runs("weft", "lamps")));
         m.add(activity("elsewhere", every(10ms), budget(10us), runs("feeding")));
     },
     R"(loom: component "feeding" controls the behaviour of "weft", which activity "logic" runs; run both in that one)"},
};
INSTANTIATE_TEST_SUITE_P(controls, Refusal, planted_into(controlled_loom, control_faults), name_of);

} // namespace
