// Writes PlantUML state charts.
#include "toolchain/tools/chart/plantuml.hpp"

#include "toolchain/tools/chart/program_text.hpp"

namespace tappet::chart {

namespace {

/// Writes characters that PlantUML would read as markup or line end as numbers.
std::string plain(std::string_view text) {
    std::string escaped;
    for (const char character : text) switch (character) {
        case '<': escaped += "&#60;"; break;
        case '~': escaped += "&#126;"; break;
        case '\\': escaped += "&#92;"; break;
        case '"': escaped += "&#34;"; break;
        case '\n': escaped += "\\n"; break;
        default: escaped += character;
        }
    return escaped;
}

class Writer {
public:
    explicit Writer(const Chart& chart) : chart_{chart}, names_{chart.machine}, regions_{names_} {}

    std::string write() {
        text_ += "@startuml\nhide empty description\ntitle " + plain(chart_.name) + "\n";
        write_regions(no_state, "");
        write_transitions(nowhere);
        if (names_.final_state != no_state && names_.initial_top != no_state)
            text_ += "note as always\n  always valid by request:\n  any state --> " +
                     plain(name(names_.final_state)) + "\n  " + plain(name(names_.final_state)) + " --> " +
                     plain(name(names_.initial_top)) + "\nend note\n";
        return text_ + "@enduml\n";
    }

private:
    static constexpr std::size_t nowhere = static_cast<std::size_t>(-1);
    [[nodiscard]] std::string_view name(StateIndex state) const { return chart_.machine.states[state].name; }
    [[nodiscard]] std::string id(StateIndex state) const { return "s_" + identifier(name(state)); }

    void write_regions(StateIndex composite, const std::string& indent) {
        bool first = true;
        for (const std::size_t k : regions_.inside(composite)) {
            if (!first) text_ += indent + "--\n";
            first = false;
            for (const StateIndex state : regions_.all()[k].states) write_state(state, indent);
            if (regions_.all()[k].initial != no_state)
                text_ += indent + "[*] --> " + id(regions_.all()[k].initial) + "\n";
            if (is_concurrent(k)) write_transitions(k);
        }
    }

    // PlantUML draws an arrow between states of one region only inside that region, and none across its
    // border. Such an arrow starts or ends at the composite, and its label names the state.
    [[nodiscard]] bool is_concurrent(std::size_t region) const {
        return regions_.inside(regions_.all()[region].parent).size() > 1 &&
               regions_.all()[region].parent != no_state;
    }
    /// Returns the innermost concurrent region around a state; nowhere: none.
    [[nodiscard]] std::size_t concurrent_around(StateIndex state) const {
        for (; state != no_state; state = names_.parent[state])
            if (is_concurrent(regions_.of(state))) return regions_.of(state);
        return nowhere;
    }
    [[nodiscard]] bool is_around(std::size_t region, StateIndex state) const {
        for (; state != no_state; state = names_.parent[state])
            if (regions_.of(state) == region) return true;
        return false;
    }
    /// Returns the state to which an arrow between this state and the other one is attached.
    [[nodiscard]] StateIndex anchor(StateIndex state, StateIndex other) const {
        for (std::size_t k = concurrent_around(state); k != nowhere && !is_around(k, other);
             k = concurrent_around(state))
            state = regions_.all()[k].parent;
        return state;
    }
    void write_transitions(std::size_t scope) {
        for (std::size_t t = 0; t < names_.transitions(); ++t) {
            if (names_.from[t] == no_state) continue;
            const StateIndex to = names_.to[t] == no_state ? names_.from[t] : names_.to[t];
            if (concurrent_around(anchor(names_.from[t], to)) == scope) write_transition(t);
        }
    }

    void write_state(StateIndex state, const std::string& indent) {
        const StateRow& row = chart_.machine.states[state];
        text_ +=
            indent + "state \"" + plain(row.name) + "\" as " + id(state) + (row.final ? " #LightGreen" : "");
        if (names_.composite[state]) {
            text_ += " {\n";
            write_regions(state, indent + "  ");
            text_ += indent + "}\n";
        } else {
            text_ += "\n";
        }
        if (row.final) line(state, indent, "«final»");
        if (!row.precondition.empty())
            line(state, indent, "precondition [" + guard_label(chart_, row.precondition) + "]");
        describe(state, indent, "entry", row.entry);
        describe(state, indent, "do", row.run);
        describe(state, indent, "handle", row.handle);
        describe(state, indent, "exit", row.exit);
    }
    void line(StateIndex state, const std::string& indent, const std::string& what) {
        text_ += indent + id(state) + " : " + plain(what) + "\n";
    }
    void describe(StateIndex state, const std::string& indent, const char* part, ProgramRef program) {
        if (!program.empty()) line(state, indent, std::string{part} + " / " + program_label(chart_, program));
    }

    [[nodiscard]] std::string head(const TransitionRow& row) const {
        std::string text;
        if (row.on_event) text = event_label(chart_, row);
        if (row.timed) text = "after " + time_text(row.after);
        return text;
    }
    static void add(std::string& text, const std::string& piece) {
        text += (text.empty() || text.back() == ' ' ? "" : " ") + piece;
    }

    void write_transition(std::size_t t) {
        const TransitionRow& row = chart_.machine.transitions[t];
        const StateIndex from = names_.from[t];
        std::string label = head(row);
        std::string rest;
        if (!row.guard.empty()) add(rest, "[" + guard_label(chart_, row.guard) + "]");
        if (!row.then.empty()) add(rest, "/ " + program_label(chart_, row.then));
        if (row.to.empty() && !row.has_otherwise) { // internal: a reaction of the state
            if (!rest.empty()) add(label, rest);
            line(from, "", label);
            return;
        }
        const StateIndex end = names_.to[t] == no_state ? from : names_.to[t];
        std::string source = id(anchor(from, end));
        if (anchor(from, end) != from) label.insert(0, "in " + std::string{name(from)} + ": ");
        if (row.has_otherwise) { // a choice: UML's else branch of a guard
            const std::string choice = "c_" + std::to_string(t);
            text_ +=
                "state " + choice + " <<choice>>\n" + source + " --> " + choice + arrow_label(label) + "\n";
            std::string other = "[else]";
            if (!row.otherwise.empty()) add(other, "/ " + program_label(chart_, row.otherwise));
            const StateIndex to = row.otherwise_to.empty() ? no_state : names_.find(row.otherwise_to);
            if (to == no_state) add(other, "(no state is left)");
            text_ += choice + " --> " + id(to == no_state ? anchor(from, end) : anchor(to, from)) +
                     arrow_label(other) + "\n";
            source = choice;
            label = rest;
        } else if (!rest.empty()) {
            add(label, rest);
        }
        if (row.enters == EntryKind::deep_history) add(label, "(deep history)");
        if (!row.because.empty()) label += "\n" + std::string{row.because};
        if (row.to.empty()) add(label, "(no state is left)");
        if (anchor(end, from) != end) add(label, "(to " + std::string{name(end)} + ")");
        const bool shallow = row.enters == EntryKind::shallow_history && anchor(end, from) == end;
        text_ +=
            source + " --> " + id(anchor(end, from)) + (shallow ? "[H]" : "") + arrow_label(label) + "\n";
    }
    static std::string arrow_label(const std::string& label) {
        return label.empty() ? "" : " : " + plain(label);
    }

    const Chart& chart_;
    StateHierarchy names_;
    Regions regions_;
    std::string text_;
};

} // namespace

std::string program_to_plantuml(const Chart& chart, ProgramIndex number) {
    const ProgramTables& tables = *chart.programs;
    const ProgramRow& row = tables.programs[number];
    const ProgramText reader{chart};
    const auto id = [](std::size_t node) { return "n" + std::to_string(node); };
    std::string text =
        "@startuml\nhide empty description\ntitle " + plain(chart.name) + ": " + plain(row.name) + "\n";
    text += "[*] --> " + (row.first >= row.last ? std::string{"[*]"} : id(row.first)) + "\n";
    for (std::size_t n = row.first; n < row.last && n < tables.nodes.size(); ++n) {
        const NodeRow& node = tables.nodes[n];
        const Node read = reader.node(static_cast<NodeIndex>(n));
        text += "state \"" + (node.line != 0 ? "line " + std::to_string(node.line) : id(n)) + "\" as " +
                id(n) + "\n";
        for (const Statement& each : read.statements) text += id(n) + " : " + plain(each.text) + "\n";
        if (node.yields) text += id(n) + " : (goes on in the next step)\n";
        for (std::size_t a = 0; a < node.arcs; ++a) {
            const ArcRow& arc = tables.arcs[node.first_arc + a];
            std::string label;
            if (arc.after != no_data) label = "after a time";
            if (arc.condition != no_condition)
                label += (label.empty() ? "[" : " [") + reader.condition(arc.condition) + "]";
            const std::string to = arc.to == end_node ? "[*]" : arc.to == no_node ? "failed" : id(arc.to);
            text += id(n) + " --> " + to + (label.empty() ? "" : " : " + plain(label)) + "\n";
        }
        if (node.on_error != no_node)
            text += id(n) + " --> " + (node.on_error == end_node ? "[*]" : id(node.on_error)) + " : failed\n";
    }
    return text + "@enduml\n";
}

std::string to_plantuml(const Chart& chart) {
    if (chart.machine.states.empty()) return program_to_plantuml(chart, 0);
    return Writer{chart}.write();
}

} // namespace tappet::chart
