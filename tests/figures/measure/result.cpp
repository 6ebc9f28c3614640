// A result as JSON, to and fro, and as text.
#include "tests/figures/measure/result.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <map>

namespace tappet::figures {

using nlohmann::json;

const char* to_text(Standing role) noexcept {
    constexpr std::array words{"ours", "floor", "peer"};
    return words[static_cast<std::size_t>(role)];
}
void to_json(json& j, Standing role) { j = to_text(role); }
void from_json(const json& j, Standing& role) {
    const std::string& word = j.get_ref<const std::string&>();
    role = word == "floor" ? Standing::floor : word == "peer" ? Standing::peer : Standing::ours;
}

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Summary, median, mean, p99, p999, max, count)
void to_json(json& j, const Row& row) {
    j = row.summary;
    j["name"] = row.name;
    j["role"] = row.role;
    if (row.instructions) j["instructions"] = *row.instructions;
}
void from_json(const json& j, Row& row) {
    row = {j.at("name"), j.at("role"), j.get<Summary>()};
    if (const auto found = j.find("instructions"); found != j.end()) row.instructions = found->get<double>();
}
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Figure, id, title, unit, source, how, rows)
void to_json(json& j, const Goal& goal) {
    j = {{"text", goal.text}, {"limit", goal.limit},   {"measured", goal.measured},
         {"unit", goal.unit}, {"detail", goal.detail}, {"held", goal.held()}};
}
void from_json(const json& j, Goal& goal) {
    goal = {j.at("text"), j.at("limit"), j.at("measured"), j.at("unit"), j.at("detail")};
}
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Statement, text, held, measured)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Series, name, role, points)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Plot, id, title, x, y, histogram, log_x, log_y, series)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Result, program, setting, figures, goals, statements, plots, notes)

const Row* Result::find(std::string_view figure, std::string_view row) const {
    for (const Figure& each : figures)
        if (each.id == figure)
            for (const Row& found : each.rows)
                if (found.name == row) return &found;
    return nullptr;
}

std::string Result::text() const { return json(*this).dump(1, ' ', false, json::error_handler_t::replace); }

std::expected<Result, std::string> read_result(const std::string& path) {
    std::ifstream file{path};
    if (!file) return std::unexpected("there is no " + path);
    if (file.peek() == EOF) return std::unexpected(path + " is empty");
    const auto null_is_no_number = [](int, json::parse_event_t event, json& value) {
        if (event == json::parse_event_t::value && value.is_null())
            value = std::numeric_limits<double>::quiet_NaN();
        return true;
    };
    try {
        return json::parse(file, null_is_no_number).get<Result>();
    } catch (const json::exception& wrong) {
        return std::unexpected(path + " is no result of figures: " + wrong.what());
    }
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
            std::printf("  %-44s %-6s %10.2f %10.2f %10.2f %10.2f %12.1f ", row.name.c_str(),
                        to_text(row.role), s.median, s.mean, s.p99, s.p999, s.max);
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

Plot histogram_plot(std::string id, std::string title, std::string x, std::string y,
                    std::vector<Series> series, bool log_x) {
    return {std::move(id), std::move(title), std::move(x), std::move(y), true, log_x,
            true,          std::move(series)};
}

} // namespace tappet::figures
