// Writes one state machine as a Promela process: regions, guards, transitions in their order.
#include "toolchain/tools/chart/promela_machine.hpp"

#include <algorithm>

namespace tappet::chart {

namespace {

constexpr const char* nobody = "255";

std::string both(const std::string& a, const std::string& b) {
    if (a.empty()) return b;
    if (b.empty()) return a;
    return a + " && " + b;
}

} // namespace

MachineModel::MachineModel(const Chart& chart, const ModelWords& words)
    : chart_{chart}, words_{words}, names_{chart.machine}, regions_{names_}, m_{identifier(chart.name)} {
    for (std::size_t i = 0; i < names_.triggers; ++i) {
        const std::string name{names_.trigger_name(i)};
        triggers_.push_back(name.contains('.') ? name : chart.component + "." + name);
    }
    if (chart.programs == nullptr) return;
    // A variable that no program writes can only be changed by the world: its value is unknown.
    const ProgramText reader{chart};
    for (const VariableRow& row : chart.programs->variables) {
        if (reader.kept(row.at) == nullptr) continue;
        const bool is_fixed = row.kind == VariableKind::constant || row.kind == VariableKind::parameter;
        const bool is_written = std::ranges::any_of(chart.programs->instructions,
                                                    [&](const Instruction& in) { return in.to == row.at; });
        if (is_fixed || is_written) variables_.push_back(row.at);
    }
}

std::string MachineModel::in(StateIndex state) const {
    return "in_" + m_ + "_" + identifier(chart_.machine.states[state].name);
}

std::string MachineModel::transition_mark(std::size_t t) const {
    const TransitionRow& row = chart_.machine.transitions[t];
    return mark("transition " + chart_.name + " " + std::to_string(t + 1) + " " + std::string{row.from} +
                " -> " + std::string{row.to.empty() ? row.from : row.to});
}

std::string MachineModel::hears(std::size_t trigger) const {
    std::string text;
    for (std::size_t t = 0; t < names_.transitions(); ++t)
        if (names_.trigger[t] == trigger && names_.from[t] != no_state)
            text += (text.empty() ? "" : " || ") + in(names_.from[t]);
    return text;
}

bool MachineModel::needs_history(std::size_t region) const {
    for (std::size_t t = 0; t < names_.transitions(); ++t) {
        const EntryKind kind = chart_.machine.transitions[t].enters;
        if (kind == EntryKind::initial || names_.to[t] == no_state) continue;
        const StateIndex outer = regions_.all()[region].parent;
        if (outer == names_.to[t]) return true;
        if (kind == EntryKind::deep_history && outer != no_state && names_.is_inside(outer, names_.to[t]))
            return true;
    }
    return false;
}

bool MachineModel::has_runs() const {
    return std::ranges::any_of(chart_.machine.states, [&](const StateRow& row) {
        return row.run.program != no_program ||
               (row.run.call != nullptr && !words_.program(row.run.call).empty());
    });
}

std::string MachineModel::declarations() const {
    std::string text = "/* state machine " + chart_.name + " */\n";
    text += "chan " + m_ + "_events = [QUEUE] of { byte };\n";
    text += "bool " + m_ + "_wants_final, " + m_ + "_wants_initial, " + m_ + "_error, " + m_ + "_started;\n";
    text += "bool " + m_ + "_go = true;\n";
    for (std::size_t k = 0; k < regions_.all().size(); ++k) {
        text += "byte " + active(k) + " = 255;\n";
        if (needs_history(k)) text += "byte " + kept_active(k) + " = 255;\n";
    }
    for (std::size_t i = 0; i < names_.states(); ++i)
        text += "#define " + in(static_cast<StateIndex>(i)) + " (" +
                active(regions_.of(static_cast<StateIndex>(i))) + " == " + std::to_string(i) + ")\n";
    if (chart_.programs == nullptr) return text;
    const ProgramText reader{chart_};
    for (const DataOffset at : variables_)
        text += "byte " + ProgramText::model_name(chart_, *reader.kept(at)) + " = " +
                std::to_string(reader.initial_value(*reader.kept(at))) + ";\n";
    return text;
}

// ---- guards

void MachineModel::ask(Guard& guard, ConditionRef condition) const {
    if (condition.empty()) return;
    std::string known;
    if (condition.call != nullptr) {
        known = words_.guard(condition.call);
    } else if (chart_.programs != nullptr) {
        known = ProgramText{chart_}.expression(condition.condition).model;
        for (const VariableRow& row : chart_.programs->variables) // an unkept one makes the guard free
            if (known.contains(ProgramText::model_name(chart_, row)) &&
                std::ranges::find(variables_, row.at) == variables_.end())
                known.clear();
    }
    if (known.empty())
        guard.is_free = true;
    else
        guard.model = both(guard.model, "(" + known + ")");
}

std::vector<StateIndex> MachineModel::entered_by(StateIndex from, StateIndex to) const {
    std::vector<StateIndex> entered;
    for (std::size_t level = names_.shared_depth(from, to) + 1; level <= names_.depth[to]; ++level)
        entered.push_back(names_.ancestor(to, level));
    std::vector<StateIndex> open{to};
    while (!open.empty()) {
        const StateIndex outer = open.back();
        open.pop_back();
        for (const std::size_t k : regions_.inside(outer))
            if (const StateIndex first = regions_.all()[k].initial; first != no_state) {
                entered.push_back(first);
                open.push_back(first);
            }
    }
    return entered;
}

MachineModel::Guard MachineModel::guard_of(std::size_t t) const {
    const TransitionRow& row = chart_.machine.transitions[t];
    Guard guard;
    guard.is_free = row.timed;
    ask(guard, row.guard);
    if (names_.to[t] != no_state) {
        const auto entered = entered_by(names_.from[t], names_.to[t]);
        for (const StateIndex state : entered) {
            if (row.enters == EntryKind::initial || names_.depth[state] <= names_.depth[names_.to[t]])
                ask(guard, chart_.machine.states[state].precondition);
            else if (!chart_.machine.states[state].precondition.empty())
                guard.is_free = true;
        }
    }
    return guard;
}

// ---- exit and entry

std::string MachineModel::exit_region(std::size_t region) {
    std::string options;
    for (const StateIndex state : regions_.all()[region].states) {
        std::string text;
        for (const std::size_t inner : regions_.inside(state)) text += exit_region(inner);
        text += program(chart_.machine.states[state].exit, false);
        if (!text.empty()) options += ":: " + in(state) + " ->\n" + text;
    }
    std::string text;
    if (!options.empty()) text = "if\n" + options + ":: else -> skip\nfi;\n";
    if (needs_history(region)) text += kept_active(region) + " = " + active(region) + ";\n";
    return text + active(region) + " = " + nobody + ";\n";
}

std::string MachineModel::enter(StateIndex state) {
    return active(regions_.of(state)) + " = " + std::to_string(state) + ";\n" +
           program(chart_.machine.states[state].entry, false);
}

std::string MachineModel::enter_inside(StateIndex state, EntryKind kind) {
    std::string text;
    for (const std::size_t k : regions_.inside(state)) {
        const StateIndex first = regions_.all()[k].initial;
        const EntryKind deeper = kind == EntryKind::deep_history ? kind : EntryKind::initial;
        const std::string usual =
            first == no_state ? "skip;\n" : enter(first) + enter_inside(first, EntryKind::initial);
        if (kind == EntryKind::initial) {
            text += first == no_state ? "" : usual;
            continue;
        }
        text += "if\n";
        for (const StateIndex each : regions_.all()[k].states)
            text += ":: " + kept_active(k) + " == " + std::to_string(each) + " ->\n" + enter(each) +
                    enter_inside(each, deeper);
        text += ":: else ->\n" + usual + "fi;\n";
    }
    return text;
}

std::string MachineModel::enter_path(std::size_t kept, StateIndex target, EntryKind kind) {
    std::string text;
    for (std::size_t level = kept + 1; level <= names_.depth[target]; ++level) {
        const StateIndex state = names_.ancestor(target, level);
        text += enter(state);
        if (state == target) break;
        for (const std::size_t k : regions_.inside(state)) { // regions beside the path: initial state
            const StateIndex next = names_.ancestor(target, level + 1);
            const StateIndex first = regions_.all()[k].initial;
            if (regions_.of(next) != k && first != no_state)
                text += enter(first) + enter_inside(first, EntryKind::initial);
        }
    }
    return text + enter_inside(target, kind);
}

// Writes the transition program, exits from the inside, entries from the outside (thesis 5.2.1).
std::string MachineModel::take(StateIndex from, StateIndex to, ProgramRef then, EntryKind kind) {
    std::string text = program(then, false);
    if (to == no_state) return text;
    const std::size_t kept = names_.shared_depth(from, to);
    return text + exit_region(regions_.of(names_.ancestor(from, kept + 1))) + enter_path(kept, to, kind);
}

std::string MachineModel::captures(const TransitionRow& row) const {
    if (chart_.programs == nullptr) return {};
    const ProgramText reader{chart_};
    std::string text;
    for (std::size_t c = 0; c < row.captures; ++c) {
        const CaptureRow& capture = chart_.machine.captures[row.first_capture + c];
        text += any_value(reader, captured_at(chart_, capture), false);
    }
    return text;
}

// ---- transitions

// Inner states first, then in the order of the table; the known part of an earlier guard disables later ones.
std::string MachineModel::conditions() {
    std::string text;
    std::vector<std::pair<std::size_t, std::string>> certain;
    for (std::size_t t = 0; t < names_.transitions(); ++t) {
        const TransitionRow& row = chart_.machine.transitions[t];
        if (row.on_event || names_.from[t] == no_state) continue;
        const Guard guard = guard_of(t);
        if (!guard.is_free) certain.emplace_back(t, both(in(names_.from[t]), guard.model));
    }
    for (std::size_t t = 0; t < names_.transitions(); ++t) {
        const TransitionRow& row = chart_.machine.transitions[t];
        const StateIndex from = names_.from[t];
        if (row.on_event || from == no_state) continue;
        std::string open = both(in(from), guard_of(t).model);
        if (has_runs()) open += " && at == 0"; // a run program under way comes first
        for (const auto& [earlier, holds] : certain) {
            const StateIndex other = names_.from[earlier];
            const bool is_first = other == from ? earlier < t : names_.is_inside(other, from);
            if (is_first) open += " && !(" + holds + ")";
        }
        text += ":: " + open + " ->\nhere = 0;" + transition_mark(t) + "\n" +
                take(from, names_.to[t], row.then, row.enters) + "CHECK;\n";
    }
    return text;
}

std::string MachineModel::free_of_taken(StateIndex state) const {
    if (!regions_.orthogonal()) return "!taken";
    return "!taken" + std::to_string(regions_.of(state)) + " && was" + std::to_string(regions_.of(state)) +
           " == " + std::to_string(state);
}

std::string MachineModel::note_taken(StateIndex state) const {
    std::string text = "taken = 1;\n";
    if (!regions_.orthogonal()) return text;
    for (; state != no_state; state = names_.parent[state])
        text += "taken" + std::to_string(regions_.of(state)) + " = 1;\n";
    return text;
}

std::string MachineModel::try_transition(std::size_t t) {
    const TransitionRow& row = chart_.machine.transitions[t];
    const StateIndex from = names_.from[t];
    const Guard guard = guard_of(t);
    const std::string here = both(in(from), free_of_taken(from));
    const std::string taken =
        captures(row) + note_taken(from) + take(from, names_.to[t], row.then, row.enters);
    std::string otherwise = "skip;\n";
    if (row.has_otherwise)
        otherwise = captures(row) + note_taken(from) +
                    take(from, row.otherwise_to.empty() ? no_state : names_.find(row.otherwise_to),
                         row.otherwise, EntryKind::initial);
    std::string text =
        "if\n:: " + both(here, guard.model) + " ->\nhere = 0;" + transition_mark(t) + "\n" + taken;
    if (guard.is_free)
        text += ":: " + here + " ->" + mark("its guard says no") + "\n" + otherwise;
    else if (!guard.model.empty())
        text += ":: " + here + " && !(" + guard.model + ") ->" + mark("its guard says no") + "\n" + otherwise;
    return text + ":: !(" + here + ") -> skip\nfi;\n";
}

std::string MachineModel::on_event(std::size_t trigger) {
    std::vector<std::size_t> order;
    for (std::size_t t = 0; t < names_.transitions(); ++t)
        if (names_.trigger[t] == trigger && names_.from[t] != no_state) order.push_back(t);
    std::ranges::sort(order, [&](std::size_t a, std::size_t b) {
        const std::size_t inner_a = names_.depth[names_.from[a]];
        const std::size_t inner_b = names_.depth[names_.from[b]];
        return inner_a != inner_b ? inner_a > inner_b : a < b;
    });
    std::string text = ":: " + m_ + "_events?" + std::to_string(trigger) + " ->" +
                       mark("event " + triggers_[trigger]) + "\ntaken = 0;\n";
    std::string reset;
    if (regions_.orthogonal())
        for (std::size_t k = 0; k < regions_.all().size(); ++k) {
            text += "was" + std::to_string(k) + " = " + active(k) + ";\n";
            reset += "taken" + std::to_string(k) + " = 0;\nwas" + std::to_string(k) + " = 0;\n";
        }
    for (const std::size_t t : order) text += try_transition(t);
    std::string handles;
    for (std::size_t i = 0; i < names_.states(); ++i) {
        const std::string handle = program(chart_.machine.states[i].handle, false);
        if (!handle.empty()) handles += ":: !taken && " + in(static_cast<StateIndex>(i)) + " ->\n" + handle;
    }
    if (!handles.empty()) text += "if\n" + handles + ":: else -> skip\nfi;\n";
    text += reset + "CHECK;\n";
    if (has_runs()) text += "if\n:: taken -> at = 0\n:: else -> skip\nfi;\n";
    return text + "taken = 0;\n";
}

std::string MachineModel::requests() {
    const StateIndex last = names_.final_state;
    std::string text;
    std::string leave;
    for (const std::size_t k : regions_.inside(no_state)) leave += exit_region(k);
    if (last == no_state)
        return ":: " + m_ + "_wants_final -> " + m_ + "_wants_final = false\n:: " + m_ +
               "_wants_initial -> " + m_ + "_wants_initial = false\n";
    text += ":: " + m_ + "_wants_final && !" + in(last) + " ->" + mark("request " + chart_.name + " final") +
            "\n" + leave + m_ + "_wants_final = false;\n" + m_ + "_error = false;\nat = 0;\n" +
            enter_path(0, last, EntryKind::initial) + "CHECK;\n";
    text += ":: " + m_ + "_wants_final && " + in(last) + " -> " + m_ + "_wants_final = false;\n";
    text += ":: " + m_ + "_wants_initial && !" + in(last) + " -> " + m_ + "_wants_initial = false;\n";
    if (names_.initial_top != no_state) {
        std::string begin;
        for (const std::size_t k : regions_.inside(no_state))
            if (const StateIndex first = regions_.all()[k].initial; first != no_state)
                begin += enter(first) + enter_inside(first, EntryKind::initial);
        text += ":: " + m_ + "_wants_initial && " + in(last) + " ->" +
                mark("request " + chart_.name + " initial") + "\n" + leave + m_ +
                "_wants_initial = false;\nat = 0;\n" + begin + "CHECK;\n";
    }
    return text;
}

std::string MachineModel::runs() {
    std::string text;
    for (std::size_t level = 1; level <= max_state_depth; ++level)
        for (std::size_t i = 0; i < names_.states(); ++i) {
            if (names_.depth[i] != level) continue;
            const auto state = static_cast<StateIndex>(i);
            const std::string run = program(chart_.machine.states[i].run, true);
            if (!run.empty())
                text += "if\n:: " + in(state) + " && !" + m_ + "_error ->\n" + run + ":: else -> skip\nfi;\n";
        }
    return text;
}

std::string MachineModel::resumes() const {
    std::string text;
    for (std::size_t i = 0; i < waits_.size(); ++i)
        text += ":: at == " + std::to_string(i + 1) + " -> at = 0; goto " + waits_[i] + "\n";
    return text.empty() ? text : "if\n" + text + ":: else -> skip\nfi;\n";
}

std::string MachineModel::process() {
    labels_ = 0;
    waits_.clear();
    std::string begin;
    for (const std::size_t k : regions_.inside(no_state))
        if (const StateIndex first = regions_.all()[k].initial; first != no_state)
            begin += enter(first) + enter_inside(first, EntryKind::initial);
    const bool has_run = has_runs();
    const std::string run = runs();
    std::string text = "active proctype machine_" + m_ + "() {\nbool taken;\nbyte at;\n";
    if (regions_.orthogonal())
        for (std::size_t k = 0; k < regions_.all().size(); ++k)
            text += "bool taken" + std::to_string(k) + ";\nbyte was" + std::to_string(k) + ";\n";
    text += "atomic {\n" + m_ + "_started = true;\n" + begin + "CHECK;\n}\n";
    text += m_ + "_loop:\natomic {\nROOM;\n"; // others may run between two transitions
    for (std::size_t i = 0; i < names_.states(); ++i)
        text += "if\n:: " + in(static_cast<StateIndex>(i)) + " -> here = 0;" +
                mark("state " + chart_.name + " " + std::string{chart_.machine.states[i].name}) +
                "\n:: else -> skip\nfi;\n";
    text += resumes() + run;
    // An idle machine waits here: for a condition, an event or a request.
    text += m_ + "_wait:\nif\n" + conditions();
    for (std::size_t i = 0; i < triggers_.size(); ++i) text += on_event(i);
    text += ":: " + m_ + "_wants_final || " + m_ + "_wants_initial -> goto " + m_ + "_request\n";
    if (has_run) {
        std::string handles;
        for (std::size_t i = 0; i < names_.states(); ++i) {
            const std::string handle = program(chart_.machine.states[i].handle, false);
            const StateRow& row = chart_.machine.states[i];
            if (row.run.empty() && handle.empty()) continue;
            handles += ":: " + in(static_cast<StateIndex>(i)) + " && at == 0 ->" +
                       mark("no transition: handle, and run again") + "\n" + handle + "YIELD(" + m_ + ");\n";
        }
        text += handles;
    }
    if (names_.final_state != no_state)
        text += ":: " + at_final() + " && len(" + m_ + "_events) == 0 -> goto end_" + m_ + "\n";
    text += "fi\n};\ngoto " + m_ + "_loop;\n";
    text += "end_" + m_ + ":\n(len(" + m_ + "_events) > 0 || " + m_ + "_wants_initial || " + m_ +
            "_wants_final);\ngoto " + m_ + "_loop;\n";
    text += m_ + "_request:\natomic {\nif\n" + requests() + "fi\n};\ngoto " + m_ + "_loop;\n";
    text += m_ + "_failed:\n" + m_ + "_error = true;\nat = 0;\nend_" + m_ + "_error:\nif\n:: " + m_ +
            "_events?_\n:: " + m_ + "_wants_initial -> " + m_ + "_wants_initial = false\n";
    if (names_.final_state != no_state) text += ":: " + m_ + "_wants_final -> goto " + m_ + "_request\n";
    return text + "fi;\ngoto end_" + m_ + "_error\n}\n";
}

} // namespace tappet::chart
