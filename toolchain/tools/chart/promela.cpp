// Combines the state machines, the reactions of a machine table and the rows of a verification.
#include "toolchain/tools/chart/promela.hpp"

#include "kernel/base/nearest.hpp"
#include "toolchain/tools/chart/promela_machine.hpp"

#include <algorithm>
#include <deque>
#include <set>

namespace tappet::chart {

namespace {

/// How many triggers may wait for a machine, and messages for an activity. The world waits while a trigger is
/// present; world and machines wait while more than a few messages are: the schedulability analysis shows
/// that receivers keep up. An assertion checks that the messages of one step fit.
constexpr std::size_t queue = 6;
constexpr const char* few = " <= 1";

std::string component_of(std::string_view name) { return std::string{name.substr(0, name.find('.'))}; }

class Composer {
public:
    explicit Composer(const Composition& of) : of_{of} {
        words_.emit = [this](const std::string& event) { return emission(event); };
        words_.operation = [this](const std::string& name) { return operation(name); };
        words_.program = [this](StateProgram program) { return program_text(program); };
        words_.guard = [this](StateGuard guard) { return guard_text(guard); };
        for (const Chart& chart : of.charts)
            if (!chart.machine.states.empty()) machines_.emplace_back(chart, words_);
    }

    PromelaModel write() {
        check();
        find_activities();
        std::string processes;
        for (MachineModel& machine : machines_) processes += machine.process();
        for (std::size_t a = 0; a < activities_.size(); ++a) processes += activity(a);
        processes += stopper() + operators() + scheduler();
        if (!fault_.empty()) return {{}, fault_};
        return {head() + processes, {}};
    }

private:
    struct Activity {
        std::string name;
        std::vector<std::string> messages; ///< operations sent to it, by number
        std::vector<std::string> world;    ///< events of its components that the world causes
    };

    void fail(const std::string& what) {
        if (fault_.empty()) fault_ = what;
    }

    // ---- the rows

    void check() {
        for (const ModelRow& row : of_.model) {
            for (const std::string_view event : row.emits) check_event(event);
            if (row.kind == ModelKind::happens || row.kind == ModelKind::only_when) check_event(row.name);
            if (row.kind == ModelKind::operation) check_name(row.name, FacetKind::operation, "operation");
        }
    }
    void check_event(std::string_view name) { check_name(name, FacetKind::event, "event"); }
    void check_name(std::string_view name, FacetKind kind, const std::string& what) {
        Nearest nearest{name};
        std::vector<std::string> all;
        for (const ComponentRow& component : of_.machine.components)
            for (const Facet& facet : component.type->facets)
                if (facet.kind == kind)
                    all.push_back(std::string{component.name} + "." + std::string{facet.name});
        if (std::ranges::find(all, name) != all.end()) return;
        for (const std::string& each : all) nearest.consider(each);
        fail("verification of \"" + std::string{of_.machine.name} + "\": there is no " + what + " \"" +
             std::string{name} + "\"; " +
             (nearest.best().empty() ? "name one of the machine's components'"
                                     : "did you mean \"" + std::string{nearest.best()} + "\"?"));
    }
    [[nodiscard]] std::vector<const ModelRow*> rows(ModelKind kind, std::string_view name) const {
        std::vector<const ModelRow*> found;
        for (const ModelRow& row : of_.model)
            if (row.kind == kind && row.name == name) found.push_back(&row);
        return found;
    }
    [[nodiscard]] bool is_modelled(std::string_view operation) const {
        return !rows(ModelKind::operation, operation).empty();
    }

    std::string effect(const ModelRow& row) {
        std::string text;
        if (!row.sets.empty()) text += std::string{row.sets} + ";\n";
        for (const std::string_view event : row.emits) text += emission(std::string{event});
        return text.empty() ? "skip;\n" : text;
    }
    /// Among several rows, the first whose condition holds applies.
    std::string effects(const std::vector<const ModelRow*>& all) {
        std::string text;
        std::size_t open = 0;
        for (const ModelRow* const row : all) {
            if (row->when.empty()) {
                text += effect(*row);
                break;
            }
            text += "if\n:: (" + std::string{row->when} + ") ->\n" + effect(*row) + ":: else ->\n";
            ++open;
            if (row == all.back()) text += "skip;\n";
        }
        for (std::size_t i = 0; i < open; ++i) text += "fi;\n";
        return text;
    }
    std::string operation(const std::string& name) {
        const auto all = rows(ModelKind::operation, name);
        return all.empty() ? std::string{} : effects(all);
    }
    std::string program_text(StateProgram program) {
        std::vector<const ModelRow*> all;
        for (const ModelRow& row : of_.model)
            if (row.kind == ModelKind::program && row.program == program) all.push_back(&row);
        return all.empty() ? std::string{} : effects(all);
    }
    [[nodiscard]] std::string guard_text(StateGuard guard) const {
        for (const ModelRow& row : of_.model)
            if (row.kind == ModelKind::guard && row.guard == guard) return std::string{row.when};
        return {};
    }

    // ---- events: synchronous reactions at once, then messages, then the machines that hear them

    std::string emission(const std::string& event) {
        emitted_.insert(event);
        if (std::ranges::find(under_way_, event) != under_way_.end()) {
            fail("verification of \"" + std::string{of_.machine.name} + "\": \"" + event +
                 "\" leads synchronously back to itself; take one call(...) or one emits(...) out of the "
                 "ring");
            return {};
        }
        under_way_.push_back(event);
        std::string text;
        for (const ModelRow* const row : rows(ModelKind::only_when, event))
            text += "assert(" + std::string{row->when} + "); /* " + std::string{row->because} + " */\n";
        for (const bool synchronous : {true, false})
            for (const ReactionRow& row : of_.machine.reactions) {
                if (row.kind != ReactionKind::when || row.event != event ||
                    row.target.synchronous != synchronous || !is_modelled(row.target.operation))
                    continue;
                std::string reaction = synchronous ? operation(std::string{row.target.operation})
                                                   : post(std::string{row.target.operation});
                if (!row.handle.empty()) reaction = "if\n:: true ->\n" + reaction + ":: skip\nfi;\n";
                text += reaction;
            }
        for (const MachineModel& machine : machines_)
            for (std::size_t i = 0; i < machine.triggers().size(); ++i)
                if (machine.triggers()[i] == event)
                    text += "if\n:: " + machine.prefix() + "_started -> assert(len(" + machine.prefix() +
                            "_events) < QUEUE); " + machine.prefix() + "_events!" + std::to_string(i) +
                            "\n:: else -> skip\nfi;\n";
        under_way_.pop_back();
        return text;
    }
    std::string post(const std::string& operation) {
        Activity& to = activity_of(component_of(operation));
        auto place = std::ranges::find(to.messages, operation);
        if (place == to.messages.end()) place = to.messages.insert(place, operation);
        const std::string channel = "to_" + identifier(to.name);
        return "assert(len(" + channel + ") < QUEUE); " + channel + "!" +
               std::to_string(place - to.messages.begin()) + "; /* " + operation + " */\n";
    }

    // ---- activities: their events from the world, and their messages

    Activity& activity_of(const std::string& component) {
        std::string name = "world";
        for (const ActivityRow& row : of_.machine.activities)
            for (const std::string_view each : row.runs)
                if (each == component) name = std::string{row.name};
        const auto found = std::ranges::find(activities_, name, &Activity::name);
        if (found != activities_.end()) return *found;
        return activities_.emplace_back(Activity{name, {}, {}});
    }

    void find_activities() {
        // A first pass over all texts shows which messages and events exist.
        for (MachineModel& machine : machines_) static_cast<void>(machine.process());
        for (const ModelRow& row : of_.model)
            if (row.kind == ModelKind::operation || row.kind == ModelKind::happens)
                static_cast<void>(effect(row));
        std::set<std::string> world;
        for (const MachineModel& machine : machines_)
            for (const std::string& event : machine.triggers()) world.insert(event);
        for (const ReactionRow& row : of_.machine.reactions)
            if (row.kind == ReactionKind::when && is_modelled(row.target.operation))
                world.insert(std::string{row.event});
        const std::set<std::string> emitted = emitted_;
        for (const ModelRow& row : of_.model)
            if (row.kind == ModelKind::happens) world.insert(std::string{row.name});
        for (const std::string& event : world)
            if (!emitted.contains(event) || !rows(ModelKind::happens, event).empty())
                activity_of(component_of(event)).world.push_back(event);
        // The messages of a world event declare their channels.
        for (std::size_t a = 0; a < activities_.size(); ++a)
            for (const std::string& event : std::vector<std::string>{activities_[a].world})
                static_cast<void>(emission(event));
    }

    [[nodiscard]] std::string room() const {
        std::string text;
        for (const Activity& each : activities_)
            if (!each.messages.empty())
                text += (text.empty() ? "len(to_" : " && len(to_") + identifier(each.name) + ")" + few;
        return text.empty() ? "true" : text;
    }
    [[nodiscard]] std::string world_room() const {
        std::string text = "!quiet && ROOM";
        for (const MachineModel& machine : machines_) text += " && len(" + machine.prefix() + "_events) == 0";
        return text;
    }
    std::string drain(const Activity& at) {
        if (at.messages.empty()) return "CHECK;\n";
        const std::string channel = "to_" + identifier(at.name);
        std::string text = "do\n";
        for (std::size_t i = 0; i < at.messages.size(); ++i)
            text += ":: " + channel + "?" + std::to_string(i) + " ->\n" + operation(at.messages[i]);
        return text + ":: len(" + channel + ") == 0 -> break\nod;\nCHECK;\n";
    }
    std::string activity(std::size_t a) {
        const Activity at = activities_[a];
        std::string text = "active proctype activity_" + identifier(at.name) + "() {\nend_activity:\ndo\n";
        for (const std::string& event : at.world) {
            const std::string heard = of_.machine.components.empty() ? heard_now(event) : std::string{};
            const std::string guard = "WORLD" + (heard.empty() ? "" : " && (" + heard + ")");
            const auto all = rows(ModelKind::happens, event);
            const std::string mark = " /* world " + event + " */\n";
            if (all.empty())
                text += ":: atomic { " + guard + " ->" + mark + emission(event) + drain(at) + "}\n";
            for (const ModelRow* const row : all)
                text += ":: atomic { " + guard +
                        (row->when.empty() ? "" : " && (" + std::string{row->when} + ")") + " ->" + mark +
                        (row->sets.empty() ? "" : std::string{row->sets} + ";\n") + emission(event) +
                        drain(at) + "}\n";
        }
        if (!at.messages.empty())
            text += ":: atomic { len(to_" + identifier(at.name) + ") > 0 ->\n" + drain(at) + "}\n";
        return text + "od\n}\n";
    }
    [[nodiscard]] std::string heard_now(const std::string& event) const {
        std::string text;
        for (const MachineModel& machine : machines_)
            for (std::size_t i = 0; i < machine.triggers().size(); ++i)
                if (machine.triggers()[i] == event) text += (text.empty() ? "" : " || ") + machine.hears(i);
        return text;
    }

    // ---- requests for final and initial states, and the release of others

    std::string operators() {
        std::string text = "#ifdef REQUESTS\nactive proctype requests() {\nend_requests:\ndo\n";
        for (const MachineModel& machine : machines_) {
            const std::string m = machine.prefix();
            text += ":: atomic { WORLD && " + m + "_started && !" + m + "_wants_final -> " + m +
                    "_wants_final = true }\n";
            text += ":: atomic { WORLD && " + m + "_started && !" + m + "_wants_initial -> " + m +
                    "_wants_initial = true }\n";
        }
        return text + "od\n}\n#endif\n";
    }
    std::string stopper() {
        std::string text = "#ifdef STOP\nactive proctype stop() {\natomic {\ntrue";
        for (const MachineModel& machine : machines_) text += " && " + machine.prefix() + "_started";
        text += " ->\nquiet = true;\n";
        for (const MachineModel& machine : machines_) text += machine.prefix() + "_wants_final = true;\n";
        text += "}\ntimeout ->\n";
        for (const MachineModel& machine : machines_)
            text += "assert(" + machine.at_final() + "); /* final is reached */\n";
        return text + "skip\n}\n#endif\n";
    }
    std::string scheduler() {
        std::string text = "active proctype scheduler() {\nend_scheduler:\ndo\n";
        for (const MachineModel& machine : machines_)
            text += ":: !" + machine.prefix() + "_go -> " + machine.prefix() + "_go = true\n";
        return text + "od\n}\n";
    }

    std::string head() {
        std::string text =
            "/* Made from the tables" +
            (of_.machine.name.empty() ? std::string{} : " of " + std::string{of_.machine.name}) +
            "; see toolchain/tools/chart/README.md. */\n#define QUEUE " + std::to_string(queue) +
            "\n#define YIELD(m) m##_go = false; m##_go\n"
            "#ifdef FAILURES\n#define MAY_FAIL(where) if :: true -> goto where :: skip fi\n#else\n"
            "#define MAY_FAIL(where) skip\n#endif\nbool quiet;\nhidden byte here;\n";
        for (const ModelRow& row : of_.model)
            if (row.kind == ModelKind::remembers)
                text += "byte " + std::string{row.name} + " = " + std::to_string(row.first) + "; /* to " +
                        std::to_string(row.largest) + " */\n";
        for (const MachineModel& machine : machines_) text += machine.declarations();
        for (const Activity& each : activities_)
            if (!each.messages.empty())
                text += "chan to_" + identifier(each.name) + " = [QUEUE] of { byte };\n#define settled_" +
                        identifier(each.name) + " (len(to_" + identifier(each.name) + ") == 0)\n";
        text += "#define ROOM (" + room() + ")\n#define WORLD (" + world_room() + ")\n#define CHECK " +
                invariants() + "\n";
        return text;
    }
    [[nodiscard]] std::string invariants() const {
        std::string text;
        for (const ModelRow& row : of_.model) {
            if (row.kind == ModelKind::always) text += "assert(" + std::string{row.when} + "); ";
            if (row.kind == ModelKind::remembers)
                text += "assert(" + std::string{row.name} + " <= " + std::to_string(row.largest) + "); ";
        }
        return text.empty() ? "skip" : text + "skip";
    }

    const Composition& of_;
    ModelWords words_;
    std::deque<MachineModel> machines_;
    std::deque<Activity> activities_;
    std::set<std::string> emitted_;
    std::vector<std::string> under_way_;
    std::string fault_;
};

} // namespace

PromelaModel to_promela(const Composition& composition) { return Composer{composition}.write(); }

PromelaModel to_promela(const Chart& chart) {
    Composition alone;
    alone.charts.push_back(chart);
    return to_promela(alone);
}

std::vector<Chart> charts_of(const ScriptUnit& unit, std::string_view component) {
    std::vector<Chart> charts;
    for (const BehaviourInstance& instance : unit.instances) {
        const BehaviourType& type = unit.types[instance.type];
        Chart chart;
        chart.component = std::string{component};
        chart.name = chart.component;
        if (!instance.name.empty() && unit.instances.size() > 1)
            chart.name += "." + std::string{instance.name};
        chart.machine = type.machine;
        if (!type.tables.programs.empty() || !type.tables.conditions.empty()) chart.programs = &type.tables;
        chart.reach = unit.reach;
        chart.image = instance.image;
        charts.push_back(std::move(chart));
    }
    return charts;
}

std::vector<Chart> charts_of(const MachineView& machine) {
    std::vector<Chart> charts;
    for (const BehaviourRow& row : machine.behaviours) {
        const ScriptUnit unit = row.unit(); // for a C++ table, a view of the row itself
        for (Chart& each : charts_of(unit, row.component)) charts.push_back(std::move(each));
    }
    return charts;
}

} // namespace tappet::chart
