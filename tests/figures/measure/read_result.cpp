// The reader's half of result.cpp: every field by its name, strictly.
#include "tests/figures/measure/read_result.hpp"

#include <nlohmann/json.hpp>

#include <fstream>
#include <limits>
#include <sstream>

namespace tappet::figures {

namespace {

using nlohmann::json;

double number(const json& value) {
    return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}
double number(const json& object, const char* name) { return number(object.at(name)); }

Standing role(const json& object) {
    const std::string& word = object.at("role").get_ref<const std::string&>();
    return word == "floor" ? Standing::floor : word == "peer" ? Standing::peer : Standing::ours;
}

Row row(const json& j) {
    Row row{j.at("name"), role(j), {}};
    row.summary = {number(j, "median"), number(j, "mean"), number(j, "p99"),
                   number(j, "p999"),   number(j, "max"),  j.at("count").get<std::size_t>()};
    if (const auto found = j.find("instructions"); found != j.end()) row.instructions = number(*found);
    return row;
}
Figure figure(const json& j) {
    Figure figure{j.at("id"), j.at("title"), j.at("unit"), j.at("source"), j.at("how"), {}};
    for (const json& each : j.at("rows")) figure.rows.push_back(row(each));
    return figure;
}
Goal goal(const json& j) {
    return {j.at("text"), number(j, "limit"), number(j, "measured"), j.at("unit"), j.at("detail")};
}
Statement statement(const json& j) { return {j.at("text"), j.at("held"), j.at("measured")}; }
Plot plot(const json& j) {
    Plot plot{j.at("id"),        j.at("title"), j.at("x"),     j.at("y"),
              j.at("histogram"), j.at("log_x"), j.at("log_y"), {}};
    for (const json& each : j.at("series")) {
        Series series{each.at("name"), role(each), {}};
        for (const json& point : each.at("points"))
            series.points.emplace_back(number(point.at(0)), number(point.at(1)));
        plot.series.push_back(std::move(series));
    }
    return plot;
}

} // namespace

std::expected<Result, std::string> parse_result(std::string_view text, const std::string& name) {
    try {
        const json j = json::parse(text);
        Result result;
        result.program = j.at("program");
        result.setting = j.at("setting");
        for (const json& each : j.at("figures")) result.figures.push_back(figure(each));
        for (const json& each : j.at("goals")) result.goals.push_back(goal(each));
        for (const json& each : j.at("statements")) result.statements.push_back(statement(each));
        for (const json& each : j.at("plots")) result.plots.push_back(plot(each));
        for (const json& each : j.at("notes")) result.notes.push_back(each);
        return result;
    } catch (const json::exception& wrong) {
        return std::unexpected(name + " is no result of figures: " + wrong.what());
    }
}

std::expected<Result, std::string> read_result(const std::string& path) {
    std::ifstream file{path};
    if (!file) return std::unexpected("there is no " + path);
    std::ostringstream text;
    text << file.rdbuf();
    if (text.view().empty()) return std::unexpected(path + " is empty");
    return parse_result(text.view(), path);
}

} // namespace tappet::figures
