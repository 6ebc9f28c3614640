// Goals, statements and figures as tables.
#include "tests/figures/report/tables.hpp"

#include <algorithm>
#include <cmath>

namespace tappet::figures {

namespace {

std::string bar(const Goal& goal) {
    const double share = goal.limit > 0 && std::isfinite(goal.measured) ? goal.measured / goal.limit : 2;
    const double width = std::clamp(share, 0.0, 2.0) * 50;
    return "<span class=\"bar" + std::string{goal.held() ? "" : " over"} +
           "\"><i style=\"width:" + std::to_string(static_cast<int>(width)) + "%\"></i><u></u></span>";
}
/// The figures that a goal was calculated from, with a link to the one whose id it begins with.
std::string linked(const std::string& detail, const Run& run) {
    for (const ProgramRun& program : run.programs)
        for (const Figure& figure : program.result.figures)
            if (detail.starts_with(figure.id) &&
                (detail.size() == figure.id.size() || std::string{":;/ "}.contains(detail[figure.id.size()])))
                return element("a", escaped(figure.id), "href=\"#" + escaped(figure.id) + "\"") +
                       escaped(detail.substr(figure.id.size()));
    return escaped(detail);
}

/// The columns of a figure.
struct Columns {
    bool spread;  ///< at least one row has several values
    bool counted; ///< instructions
    bool ours;    ///< it has floors or peers to compare with
    explicit Columns(const Figure& figure)
        : spread{std::ranges::any_of(figure.rows, [](const Row& row) { return row.summary.count > 1; })},
          counted{
              std::ranges::any_of(figure.rows, [](const Row& row) { return row.instructions.has_value(); })},
          ours{std::ranges::any_of(figure.rows, [](const Row& row) { return row.role == Standing::ours; }) &&
               std::ranges::any_of(figure.rows, [](const Row& row) { return row.role != Standing::ours; })} {}

    [[nodiscard]] std::string head() const {
        return std::string{"<tr><th></th><th>role</th>"} +
               (spread ? "<th>median</th><th>mean</th><th>p99</th><th>p99.9</th><th>max</th><th>samples</th>"
                       : "<th>value</th>") +
               (counted ? "<th>instructions</th>" : "") + (ours ? "<th>of ours</th>" : "") + "</tr>";
    }
};

/// The line below a row of ours: its ratio to each floor and each peer.
std::string ratios(const std::vector<Beside>& others, const Columns& columns) {
    std::string line;
    for (const Beside& other : others) {
        std::string more = columns.spread ? "p99 " + number_text(other.p99) + " x" : "";
        if (other.instructions)
            more += (more.empty() ? "" : ", ") + std::string{"instructions "} +
                    number_text(*other.instructions) + " x";
        line += element("span", element("b", number_text(other.median) + " x") + " " + escaped(other.name) +
                                    (more.empty() ? "" : " (" + more + ")")) +
                " "; // where a line may break
    }
    return element("tr", element("td", line, "colspan=\"10\""), "class=\"beside\"");
}

std::string table(const Figure& figure) {
    const Columns columns{figure};
    std::string rows;
    for (const Row& row : figure.rows) {
        const Summary& s = row.summary;
        const std::string role = to_text(row.role);
        const auto others = beside(figure, row);
        std::string cells =
            element("td", element("span", "", "class=\"role " + role + "\"") + escaped(row.name)) +
            element("td", role) + cell(s.median);
        if (columns.spread)
            cells += cell(s.mean) + cell(s.p99) + cell(s.p999) + cell(s.max) +
                     element("td", std::to_string(s.count), "class=\"soft\"");
        if (columns.counted) cells += row.instructions ? cell(*row.instructions) : element("td", "-");
        if (columns.ours)
            cells +=
                element("td", row.role == Standing::ours
                                  ? ""
                                  : number_text(s.median / ours_beside(figure, row).summary.median) + " x");
        rows += element("tr", cells, "class=\"" + role + (others.empty() ? "\"" : " joined\""));
        if (!others.empty()) rows += ratios(others, columns);
    }
    return element("h3", escaped(figure.title), "id=\"" + escaped(figure.id) + "\"") +
           "<p class=\"how\"><code>" + escaped(figure.id) + "</code>, " + escaped(figure.unit) +
           (figure.how.empty() ? "" : "; " + escaped(figure.how)) +
           (figure.source.empty() ? "" : "; " + escaped(figure.source)) + "</p><div class=\"wide\"><table>" +
           columns.head() + rows + "</table></div>";
}

/// "experiments.small" of "experiments.small.latency".
std::string group_of(const std::string& id) {
    const auto first = id.find('.');
    return first == id.npos ? id : id.substr(0, id.find('.', first + 1));
}

} // namespace

std::string goal_row(const Goal& goal, const Run& run) {
    return element(
        "tr",
        element("td", goal.held() ? "held" : "missed", goal.held() ? "class=\"held\"" : "class=\"missed\"") +
            element("td", escaped(goal.text) + element("span", linked(goal.detail, run), "class=\"detail\""),
                    "class=\"words\"") +
            element("td", element("b", escaped(quantity(goal.measured, goal.unit)))) +
            element("td", escaped(quantity(goal.limit, goal.unit))) + element("td", bar(goal)));
}
std::string statements(const Result& result) {
    if (result.statements.empty()) return {};
    std::string rows;
    for (const Statement& each : result.statements)
        rows += element("tr", element("td", each.held ? "true" : "false",
                                      each.held ? "class=\"held\"" : "class=\"missed\"") +
                                  element("td", escaped(each.text), "class=\"words\"") +
                                  element("td", escaped(each.measured), "class=\"words\""));
    return "<h3>Statements, as measured</h3><div class=\"wide\"><table><tr><th></th><th "
           "class=\"words\">statement</th>"
           "<th class=\"words\">what was measured</th></tr>" +
           rows + "</table></div>";
}

std::string tables(const Result& result) {
    constexpr std::size_t at_once = 24;
    std::vector<std::pair<std::string, std::string>> groups;
    for (const Figure& figure : result.figures) {
        const std::string group = result.figures.size() > at_once ? group_of(figure.id) : "";
        auto found = std::ranges::find(groups, group, &std::pair<std::string, std::string>::first);
        if (found == groups.end()) found = groups.insert(groups.end(), {group, ""});
        found->second += table(figure);
    }
    std::string all;
    for (const auto& [group, inside] : groups)
        all += group.empty() ? inside : element("details", element("summary", escaped(group)) + inside);
    return all;
}

} // namespace tappet::figures
