// Writes a result as JSON and as text.
#include "tests/figures/measure/result.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>

namespace tappet::figures {

namespace {

using nlohmann::json;

const char* word(Standing role) {
    constexpr std::array words{"ours", "floor", "peer"};
    return words[static_cast<std::size_t>(role)];
}
json to_json(const Row& row) {
    const Summary& s = row.summary;
    json j{{"name", row.name}, {"role", word(row.role)}, {"median", s.median}, {"mean", s.mean},
           {"p99", s.p99},     {"p999", s.p999},         {"max", s.max},       {"count", s.count}};
    if (row.instructions) j["instructions"] = *row.instructions;
    return j;
}
json to_json(const Figure& figure) {
    json j{{"id", figure.id},         {"title", figure.title}, {"unit", figure.unit},
           {"source", figure.source}, {"how", figure.how},     {"rows", json::array()}};
    for (const Row& row : figure.rows) j["rows"].push_back(to_json(row));
    return j;
}
json to_json(const Goal& goal) {
    return {{"text", goal.text}, {"limit", goal.limit},   {"measured", goal.measured},
            {"unit", goal.unit}, {"detail", goal.detail}, {"held", goal.held()}};
}
json to_json(const Statement& statement) {
    return {{"text", statement.text}, {"held", statement.held}, {"measured", statement.measured}};
}
json to_json(const Plot& plot) {
    json j{{"id", plot.id},       {"title", plot.title},         {"x", plot.x},
           {"y", plot.y},         {"histogram", plot.histogram}, {"log_x", plot.log_x},
           {"log_y", plot.log_y}, {"series", json::array()}};
    for (const Series& series : plot.series)
        j["series"].push_back(
            {{"name", series.name}, {"role", word(series.role)}, {"points", series.points}});
    return j;
}
template <class T>
json list(const std::vector<T>& values) {
    json j = json::array();
    for (const T& value : values) j.push_back(to_json(value));
    return j;
}

} // namespace

std::string Result::text() const {
    return json{{"program", program},
                {"setting", setting},
                {"figures", list(figures)},
                {"goals", list(goals)},
                {"statements", list(statements)},
                {"plots", list(plots)},
                {"notes", notes}}
        .dump(1, ' ', false, json::error_handler_t::replace);
}

std::string Result::write(const std::string& path) const {
    std::ofstream file{path};
    file << text() << '\n';
    return file.flush() ? std::string{} : "cannot write " + path + "; is the directory there?";
}

void Result::print() const {
    for (const Figure& figure : figures) {
        std::printf("\n%s [%s] %s\n", figure.title.c_str(), figure.unit.c_str(), figure.how.c_str());
        std::printf("  %-44s %-6s %10s %10s %10s %10s %12s %9s %7s\n", "", "", "median", "mean", "p99",
                    "p99.9", "max", "instr.", "ratio");
        double ours = 0;
        for (const Row& row : figure.rows)
            if (row.role == Standing::ours && ours == 0) ours = row.summary.median;
        for (const Row& row : figure.rows) {
            const Summary& s = row.summary;
            std::printf("  %-44s %-6s %10.2f %10.2f %10.2f %10.2f %12.1f ", row.name.c_str(), word(row.role),
                        s.median, s.mean, s.p99, s.p999, s.max);
            if (row.instructions)
                std::printf("%9.1f", *row.instructions);
            else
                std::printf("%9s", "-");
            if (ours > 0)
                std::printf(" %7.2f\n", s.median / ours);
            else
                std::printf(" %7s\n", "-");
        }
    }
    if (!goals.empty()) std::printf("\ngoals\n");
    for (const Goal& goal : goals)
        std::printf("  %-6s %8.2f %-2s (limit %.2f)  %s: %s\n", goal.held() ? "held" : "MISSED",
                    goal.measured, goal.unit.c_str(), goal.limit, goal.text.c_str(), goal.detail.c_str());
    if (!statements.empty()) std::printf("\nstatements\n");
    for (const Statement& each : statements)
        std::printf("  %-5s %s: %s\n", each.held ? "true" : "FALSE", each.text.c_str(),
                    each.measured.c_str());
    for (const std::string& note : notes) std::printf("note: %s\n", note.c_str());
    std::fflush(stdout);
}

Series histogram(std::string name, Standing role, const Samples& samples, std::size_t bins, double upto) {
    Series series{std::move(name), role, {}};
    if (samples.empty() || bins == 0) return series;
    const double from = samples.quantile(0), to = samples.quantile(upto);
    const double width = to > from ? (to - from) / static_cast<double>(bins) : 1;
    for (std::size_t i = 0; i < bins; ++i)
        series.points.emplace_back(from + static_cast<double>(i) * width, 0);
    for (const double value : samples.values()) {
        const auto bin = static_cast<std::size_t>(std::max(0.0, (value - from) / width));
        ++series.points[std::min(bin, bins - 1)].second;
    }
    return series;
}

Series log_histogram(std::string name, Standing role, const Samples& samples, int in_a_decade) {
    Series series{std::move(name), role, {}};
    const auto bin_of = [&](double value) {
        return static_cast<int>(std::floor(std::log10(value) * in_a_decade));
    };
    std::map<int, double> bins;
    for (const double value : samples.values())
        if (value > 0) ++bins[bin_of(value)];
    if (bins.empty()) return series;
    for (int bin = bins.begin()->first; bin <= bins.rbegin()->first; ++bin) {
        const auto found = bins.find(bin);
        series.points.emplace_back(std::pow(10, static_cast<double>(bin) / in_a_decade),
                                   found == bins.end() ? 0 : found->second);
    }
    return series;
}

} // namespace tappet::figures
