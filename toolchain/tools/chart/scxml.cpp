// Writes SCXML.
#include "toolchain/tools/chart/scxml.hpp"

namespace tappet::chart {

namespace {

class Writer {
public:
    explicit Writer(const Chart& chart) : chart_{chart}, names_{chart.machine}, regions_{names_} {}

    std::string write() {
        const std::string root = identifier(chart_.name);
        text_ +=
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
            "<scxml xmlns=\"http://www.w3.org/2005/07/scxml\" xmlns:tappet=\"urn:tappet\" version=\"1.0\" "
            "datamodel=\"tappet\" name=\"" +
            xml_text(chart_.name) + "\" initial=\"" + root + "\">\n";
        open(root, regions_.inside(no_state), "  ");
        if (names_.final_state != no_state)
            text_ += "    <transition event=\"request.final\" target=\"" + id(names_.final_state) + "\"/>\n";
        write_regions(no_state, root, "    ");
        close(regions_.inside(no_state), "  ");
        return text_ + "</scxml>\n";
    }

private:
    [[nodiscard]] std::string_view name(StateIndex state) const { return chart_.machine.states[state].name; }
    [[nodiscard]] std::string id(StateIndex state) const { return identifier(name(state)); }

    void open(const std::string& name, const std::vector<std::size_t>& inside, const std::string& indent) {
        text_ += indent;
        if (inside.size() > 1)
            text_ += "<parallel id=\"" + name + "\">\n";
        else if (inside.size() == 1 && regions_.all()[inside[0]].initial != no_state)
            text_ +=
                "<state id=\"" + name + "\" initial=\"" + id(regions_.all()[inside[0]].initial) + "\">\n";
        else
            text_ += "<state id=\"" + name + "\">\n";
    }
    void close(const std::vector<std::size_t>& inside, const std::string& indent) {
        text_ += indent + (inside.size() > 1 ? "</parallel>\n" : "</state>\n");
    }

    void write_regions(StateIndex composite, const std::string& outer, const std::string& indent) {
        const std::vector<std::size_t> inside = regions_.inside(composite);
        for (const std::size_t k : inside) {
            const Region& region = regions_.all()[k];
            if (inside.size() == 1) {
                for (const StateIndex state : region.states) write_state(state, indent);
                continue;
            }
            text_ += indent + "<state id=\"" + outer + "." + identifier(region.name) + "\"";
            if (region.initial != no_state) text_ += " initial=\"" + id(region.initial) + "\"";
            text_ += ">\n";
            for (const StateIndex state : region.states) write_state(state, indent + "  ");
            text_ += indent + "</state>\n";
        }
    }

    void program(const std::string& indent, const std::string& element, ProgramRef what) {
        if (what.empty()) return;
        text_ += indent + "<" + element + ">" + call(what) + "</" + element + ">\n";
    }
    [[nodiscard]] std::string call(ProgramRef what) const {
        return what.empty() ? "" : "<tappet:program text=\"" + xml_text(program_label(chart_, what)) + "\"/>";
    }

    void write_state(StateIndex state, const std::string& indent) {
        const StateRow& row = chart_.machine.states[state];
        const std::vector<std::size_t> inside = regions_.inside(state);
        const std::string in = indent + "  ";
        open(id(state), inside, indent);
        write_entry_and_exit(state, in);
        if (!row.run.empty())
            text_ += in + "<invoke type=\"urn:tappet:run\" src=\"" +
                     xml_text(program_label(chart_, row.run)) + "\"/>\n";
        program(in, "tappet:handle", row.handle);
        if (!row.precondition.empty())
            text_ += in + "<tappet:precondition cond=\"" + xml_text(guard_label(chart_, row.precondition)) +
                     "\"/>\n";
        for (std::size_t t = 0; t < names_.transitions(); ++t)
            if (names_.from[t] == state) write_transition(t, in);
        if (row.final && names_.initial_top != no_state)
            text_ +=
                in + "<transition event=\"request.initial\" target=\"" + id(names_.initial_top) + "\"/>\n";
        write_history(state, in);
        write_regions(state, id(state), in);
        close(inside, indent);
    }

    void write_entry_and_exit(StateIndex state, const std::string& in) {
        const StateRow& row = chart_.machine.states[state];
        std::string sends;
        std::string cancels;
        for (std::size_t t = 0; t < names_.transitions(); ++t) {
            const TransitionRow& out = chart_.machine.transitions[t];
            if (names_.from[t] != state || !out.timed) continue;
            const std::string timer = timer_id(t);
            sends +=
                "<send event=\"" + timer + "\" id=\"" + timer + "\" delay=\"" + delay(out.after) + "\"/>";
            cancels += "<cancel sendid=\"" + timer + "\"/>";
        }
        if (!row.entry.empty() || !sends.empty())
            text_ += in + "<onentry>" + sends + call(row.entry) + "</onentry>\n";
        if (!row.exit.empty() || !cancels.empty())
            text_ += in + "<onexit>" + cancels + call(row.exit) + "</onexit>\n";
    }
    static std::string timer_id(std::size_t t) { return "time." + std::to_string(t); }
    /// Returns a CSS2 time, as SCXML requires.
    static std::string delay(Duration time) {
        const std::string text = time_text(time);
        if (text.ends_with(" s")) return text.substr(0, text.size() - 2) + "s";
        if (text.ends_with(" ms")) return text.substr(0, text.size() - 3) + "ms";
        return std::to_string(static_cast<double>(time.count()) * 1e-6) + "ms";
    }

    void write_transition(std::size_t t, const std::string& in) {
        const TransitionRow& row = chart_.machine.transitions[t];
        std::string head = "<transition";
        if (row.on_event) head += " event=\"" + xml_text(row.event) + "\"";
        if (row.timed) head += " event=\"" + timer_id(t) + "\"";
        std::string first = head;
        if (!row.guard.empty()) first += " cond=\"" + xml_text(guard_label(chart_, row.guard)) + "\"";
        if (!row.to.empty() && names_.to[t] != no_state) first += " target=\"" + target(t) + "\"";
        std::string content;
        if (row.captures != 0)
            content += "<tappet:captures text=\"" + xml_text(event_label(chart_, row)) + "\"/>";
        content += call(row.then);
        if (!row.because.empty())
            content += "<log label=\"because\" expr=\"'" + xml_text(row.because) + "'\"/>";
        text_ += in + first + (content.empty() ? "/>\n" : ">" + content + "</transition>\n");
        if (!row.has_otherwise) return;
        std::string second = head;
        if (!row.otherwise_to.empty()) second += " target=\"" + identifier(row.otherwise_to) + "\"";
        content = call(row.otherwise);
        text_ += in + second + (content.empty() ? "/>\n" : ">" + content + "</transition>\n");
    }
    [[nodiscard]] std::string target(std::size_t t) const {
        const std::string to = id(names_.to[t]);
        switch (chart_.machine.transitions[t].enters) {
        case EntryKind::shallow_history: return to + ".history";
        case EntryKind::deep_history: return to + ".deep_history";
        case EntryKind::initial: break;
        }
        return to;
    }

    // A history is declared where a transition needs it, with the initial states as its default.
    void write_history(StateIndex state, const std::string& in) {
        for (const EntryKind kind : {EntryKind::shallow_history, EntryKind::deep_history}) {
            bool asked = false;
            for (std::size_t t = 0; t < names_.transitions(); ++t)
                asked = asked || (names_.to[t] == state && chart_.machine.transitions[t].enters == kind);
            if (!asked) continue;
            const bool deep = kind == EntryKind::deep_history;
            text_ += in + "<history id=\"" + id(state) + (deep ? ".deep_history" : ".history") +
                     "\" type=\"" + (deep ? "deep" : "shallow") + "\"><transition target=\"";
            bool first = true;
            for (const std::size_t k : regions_.inside(state)) {
                if (regions_.all()[k].initial == no_state) continue;
                text_ += (first ? "" : " ") + id(regions_.all()[k].initial);
                first = false;
            }
            text_ += "\"/></history>\n";
        }
    }

    const Chart& chart_;
    StateHierarchy names_;
    Regions regions_;
    std::string text_;
};

} // namespace

std::string to_scxml(const Chart& chart) { return Writer{chart}.write(); }

} // namespace tappet::chart
