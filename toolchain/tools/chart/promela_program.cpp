// Writes the programs of a state machine into its process: nodes are labels, arcs are jumps.
#include "toolchain/tools/chart/promela_machine.hpp"

#include <algorithm>

namespace tappet::chart {

std::string MachineModel::program(ProgramRef what, bool is_run) {
    if (what.call != nullptr) return words_.program(what.call);
    if (what.program == no_program || chart_.programs == nullptr) return {};
    return graph(what.program, is_run);
}

std::string MachineModel::any_value(const ProgramText& reader, DataOffset at, bool or_none) const {
    if (std::ranges::find(variables_, at) == variables_.end()) return {};
    const VariableRow& row = *reader.kept(at);
    const std::size_t values = row.type->names.empty() ? 2 : row.type->names.size();
    std::string text = "if\n";
    for (std::size_t v = 0; v < values; ++v)
        text += ":: " + ProgramText::model_name(chart_, row) + " = " + std::to_string(v) + "\n";
    return text + (or_none ? ":: skip\nfi;\n" : "fi;\n");
}

std::string MachineModel::statement(const ProgramText& reader, const Statement& what,
                                    const std::string& on_error) {
    std::string text;
    switch (what.kind) {
    case Statement::Kind::assign: {
        if (std::ranges::find(variables_, what.at) == variables_.end()) break;
        bool is_known = !what.value.model.empty() && !what.only_sometimes;
        for (const VariableRow& row : chart_.programs->variables)
            if (what.value.model.contains(ProgramText::model_name(chart_, row)) &&
                std::ranges::find(variables_, row.at) == variables_.end())
                is_known = false;
        if (!is_known) return any_value(reader, what.at, what.only_sometimes);
        return ProgramText::model_name(chart_, *reader.kept(what.at)) + " = " + what.value.model + ";\n";
    }
    case Statement::Kind::emit:
        text = words_.emit(what.event.contains('.') ? what.event : chart_.component + "." + what.event);
        break;
    case Statement::Kind::act:
        if (!what.event.empty())
            text =
                words_.operation(what.event.contains('.') ? what.event : chart_.component + "." + what.event);
        break;
    case Statement::Kind::fail: text = "goto " + on_error + ";\n"; break;
    }
    if (what.only_sometimes && !text.empty()) return "if\n:: true ->\n" + text + ":: skip\nfi;\n";
    return text;
}

// A program's node waits while no arc is open. Meanwhile others run, and a run program may be aborted there.
std::string MachineModel::node(const ProgramText& reader, NodeIndex number, const std::string& label,
                               bool is_run) {
    const ProgramTables& tables = *chart_.programs;
    const NodeRow& row = tables.nodes[number];
    const auto to = [&](NodeIndex target) {
        if (target == no_node) return m_ + "_failed";
        return label + (target == end_node ? "end" : std::to_string(target));
    };
    const Node read = reader.node(number);
    std::string text = label + std::to_string(number) + ":\nskip;" +
                       (row.line != 0 ? mark("line " + std::to_string(row.line)) : std::string{}) + "\n";
    if (read.may_fail) text += "MAY_FAIL(" + to(row.on_error) + ");\n";
    for (const Statement& each : read.statements) text += statement(reader, each, to(row.on_error));
    const bool goes_on = row.arcs == 1 && tables.arcs[row.first_arc].condition == no_condition &&
                         tables.arcs[row.first_arc].after == no_data;
    const bool goes_back = goes_on && tables.arcs[row.first_arc].to <= number;
    if (goes_on && !row.yields && !goes_back)
        return text + "goto " + to(tables.arcs[row.first_arc].to) + ";\n";
    text += "YIELD(" + m_ + ");\n";
    std::string wait = label + std::to_string(number) + "_wait";
    text += wait + ":\nif\n";
    std::string shut;
    bool always_open = false;
    for (std::size_t a = 0; a < row.arcs && !always_open; ++a) {
        const ArcRow& arc = tables.arcs[row.first_arc + a];
        Guard guard;
        guard.is_free = arc.after != no_data;
        if (arc.condition != no_condition) ask(guard, ConditionRef{arc.condition});
        text += ":: true" + shut + (guard.model.empty() ? "" : " && " + guard.model) + " -> goto " +
                to(arc.to) + "\n";
        if (!guard.is_free && !guard.model.empty()) shut += " && !(" + guard.model + ")";
        always_open = !guard.is_free && guard.model.empty();
    }
    if (is_run) {
        waits_.push_back(wait);
        text += ":: len(" + m_ + "_events) > 0 || " + m_ +
                "_wants_final -> at = " + std::to_string(waits_.size()) + "; goto " + m_ + "_wait\n";
    } else if (row.arcs == 0) {
        text += ":: false\n";
    }
    return text + "fi;\n";
}

std::string MachineModel::graph(ProgramIndex number, bool is_run) {
    const ProgramRow& row = chart_.programs->programs[number];
    if (row.first >= row.last) return {};
    const ProgramText reader{chart_};
    const std::string label = m_ + "_p" + std::to_string(++labels_) + "_";
    std::string text = "skip;" + mark("program " + std::string{row.name}) + "\n";
    for (NodeIndex n = row.first; n < row.last && n < chart_.programs->nodes.size(); ++n)
        text += node(reader, n, label, is_run);
    return text + label + "end:\nskip;\n";
}

} // namespace tappet::chart
