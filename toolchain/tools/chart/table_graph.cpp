// Reads the rows of a table, merges those between the same two components, and writes the graph.
#include "toolchain/tools/chart/table_graph.hpp"

#include "toolchain/tools/chart/promela.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace tappet::chart {

namespace {

std::string quoted(std::string_view text) {
    std::string safe = "\"";
    for (const char character : text) {
        if (character == '"' || character == '\\') safe += '\\';
        if (character == '\n')
            safe += "\\n";
        else
            safe += character;
    }
    return safe + "\"";
}

/// Splits "component.facet" into its two names; a single name is a facet.
std::pair<std::string_view, std::string_view> ends_of(std::string_view path) {
    const std::size_t dot = path.find('.');
    if (dot == path.npos) return {{}, path};
    return {path.substr(0, dot), path.substr(dot + 1)};
}

enum class Flows : std::uint8_t { data, happening };

struct Arrow {
    std::string_view from, to;
    Flows what = Flows::data;
    std::vector<std::string> rows{};
};

class Graph {
public:
    explicit Graph(const AcceptedMachine& machine) : machine_{machine}, table_{machine.table} {}

    std::string write() {
        for (const ConnectionRow& row : table_.connections) add_data(row);
        for (const ReactionRow& row : table_.reactions) add_reaction(row);
        for (const Chart& chart : charts_of(table_)) add_behaviour(chart);
        text_ = "digraph " + quoted(table_.name) +
                " {\n"
                "  graph [rankdir=LR, newrank=true, ranksep=0.9, nodesep=0.35, fontname=\"Helvetica\", "
                "fontsize=11, "
                "labelloc=t,\n    label=" +
                quoted(std::string{table_.name} +
                       "\nsolid: data; dashed: what makes something happen; grey: devices") +
                "];\n"
                "  node [shape=box, style=\"rounded,filled\", fillcolor=white, fontname=\"Helvetica\", "
                "fontsize=11];\n"
                "  edge [fontname=\"Helvetica\", fontsize=9, arrowsize=0.7];\n";
        for (std::size_t a = 0; a < table_.activities.size(); ++a) write_activity(a);
        write_devices();
        for (const Arrow& arrow : arrows_) write_arrow(arrow);
        return text_ + "}\n";
    }

private:
    void add(std::string_view from, std::string_view to, Flows what, const std::string& row) {
        auto found = std::ranges::find_if(arrows_, [&](const Arrow& each) {
            return each.from == from && each.to == to && each.what == what;
        });
        if (found == arrows_.end()) found = arrows_.insert(found, Arrow{from, to, what});
        if (std::ranges::find(found->rows, row) == found->rows.end()) found->rows.push_back(row);
    }

    void add_data(const ConnectionRow& row) {
        const auto [from, output] = ends_of(row.from);
        const auto [to, input] = ends_of(row.to);
        std::string label{output};
        // Writes the name once when both ends have the same one.
        if (output != input && !output.ends_with("." + std::string{input}))
            label += " → " + std::string{input};
        if (row.buffered) label += ", buffer of " + std::to_string(row.capacity);
        if (row.max_age > Duration::zero()) label += ", stale after " + time_text(row.max_age);
        if (row.wakes_reader) label += ", wakes";
        if (row.delayed_step) label += ", delayed";
        add(from, to, Flows::data, label);
    }

    void add_reaction(const ReactionRow& row) {
        const auto [from, event] = ends_of(row.event);
        const auto [to, operation] = ends_of(row.target.operation);
        std::string label = std::string{row.kind == ReactionKind::uses ? "uses"
                                        : row.target.synchronous       ? "call"
                                                                       : "tell"} +
                            " " + std::string{operation};
        if (row.kind == ReactionKind::when) label.insert(0, std::string{event} + ": ");
        if (!row.is_connected) label += ", disconnected at first";
        add(from, to, Flows::happening, label);
    }

    /// Adds the events that a behaviour hears, and the requests of its script to others.
    void add_behaviour(const Chart& chart) {
        const std::string_view component = row_of(chart.component).name; // lives as long as the table
        for (const TransitionRow& row : chart.machine.transitions) {
            const auto [from, event] = ends_of(row.event);
            if (row.on_event && !from.empty() && from != component)
                add(row_of(from).name, component, Flows::happening, std::string{event});
        }
        if (chart.programs == nullptr) return;
        for (const LinkRow& link : chart.programs->links) {
            if (link.peer >= chart.reach.size() || link.facet == LinkRow::component_itself) continue;
            const Reachable& peer = chart.reach[link.peer];
            const Facet& facet = peer.type->facets[link.facet];
            const bool is_asked = facet.kind == FacetKind::operation || facet.kind == FacetKind::method ||
                                  facet.kind == FacetKind::command;
            if (is_asked && peer.name != component)
                add(component, row_of(peer.name).name, Flows::happening, std::string{facet.name});
        }
    }

    [[nodiscard]] const ComponentRow& row_of(std::string_view name) const {
        return table_.components[find_component(table_, name)];
    }
    [[nodiscard]] std::string id(std::string_view component) const {
        return "c" + std::to_string(find_component(table_, component));
    }

    [[nodiscard]] std::string when_it_runs(const ActivityRow& row) const {
        std::string text;
        switch (row.trigger) {
        case Trigger::every:
        case Trigger::background:
            text = "every " + time_text(row.period);
            if (row.phase != Duration::zero()) text += ", " + time_text(row.phase) + " behind";
            break;
        case Trigger::on_work: text = "on work"; break;
        case Trigger::on_device: text = "on device of " + std::string{row.device}; break;
        }
        if (!row.periodic())
            text += ", at most " + std::to_string(row.at_most_n) + " in " + time_text(row.at_most_per);
        return text;
    }

    void write_activity(std::size_t a) {
        const ActivityRow& row = table_.activities[a];
        std::string label = std::string{row.name} + "\n" + when_it_runs(row) + "\n";
        if (row.real_time)
            label += "deadline " + time_text(row.deadline()) + ", priority " +
                     std::to_string(machine_.plan.activities[a].priority);
        else
            label += "not real-time";
        text_ += "  subgraph cluster_" + std::to_string(a) + " {\n    label=" + quoted(label) +
                 "; fontsize=9; labeljust=l; color=gray50; style=\"" +
                 (row.real_time ? "filled\"; fillcolor=\"#eef3fa\"" : "dashed\"") + ";\n";
        for (const std::string_view name : row.runs) {
            const ComponentRow& part = row_of(name);
            std::string box{name};
            for (const BehaviourRow& each : table_.behaviours)
                if (each.component == name) {
                    box += each.is_driven() ? "\n(" + std::string{each.unit().name} + ")" : "";
                    box += each.is_slot() ? "\n(slot)" : "";
                }
            if (!part.watched.empty()) box += "\nwatches " + std::string{part.watched};
            if (!part.controlled.empty()) box += "\ncontrols " + std::string{part.controlled};
            text_ += "    " + id(name) + " [label=" + quoted(box) + "];\n";
        }
        text_ += "  }\n";
    }

    void write_devices() {
        std::vector<std::string_view> devices;
        for (const ComponentRow& row : table_.components) {
            if (row.device.empty()) continue;
            auto found = std::ranges::find(devices, row.device);
            if (found == devices.end()) {
                found = devices.insert(found, row.device);
                text_ += "  d" + std::to_string(found - devices.begin()) + " [label=" + quoted(row.device) +
                         ", shape=box3d, style=filled, fillcolor=gray85];\n";
            }
            text_ += "  d" + std::to_string(found - devices.begin()) + " -> " + id(row.name) +
                     " [dir=both, color=gray50, penwidth=2];\n";
        }
    }

    void write_arrow(const Arrow& arrow) {
        std::string label;
        for (const std::string& row : arrow.rows) label += (label.empty() ? "" : "\n") + row;
        text_ +=
            "  " + id(arrow.from) + " -> " + id(arrow.to) + " [label=" + quoted(label) +
            (arrow.what == Flows::data ? "" : ", style=dashed, color=\"#8a3b12\", fontcolor=\"#8a3b12\"") +
            "];\n";
    }

    const AcceptedMachine& machine_;
    const MachineView& table_;
    std::vector<Arrow> arrows_;
    std::string text_;
};

} // namespace

std::string to_dot(const AcceptedMachine& machine) { return Graph{machine}.write(); }

} // namespace tappet::chart
