// A run to and from its merged JSON.
#include "tests/figures/report/run.hpp"

#include "tests/figures/measure/read_result.hpp"

#include <nlohmann/json.hpp>

namespace tappet::figures {

namespace {

using nlohmann::json;

json to_json(const Usage& u) {
    return {{"seconds", u.seconds},
            {"busy_percent", u.busy_percent},
            {"steal_percent", u.steal_percent},
            {"switches_per_second", u.switches_per_second},
            {"interrupts_per_second", u.interrupts_per_second}};
}
Usage usage(const json& j) {
    return {j.at("seconds"), j.at("busy_percent"), j.at("steal_percent"), j.at("switches_per_second"),
            j.at("interrupts_per_second")};
}
json to_json(const Noise& n) {
    return {{"work_us", n.work_us},
            {"spread_percent", n.spread_percent},
            {"worst_percent", n.worst_percent},
            {"gaps_per_second", n.gaps_per_second},
            {"longest_gap_us", n.longest_gap_us},
            {"lost_percent", n.lost_percent}};
}
Noise noise(const json& j) {
    return {j.at("work_us"),         j.at("spread_percent"), j.at("worst_percent"),
            j.at("gaps_per_second"), j.at("longest_gap_us"), j.at("lost_percent")};
}

} // namespace

std::string merged(const Run& run) {
    json machine = json::array(), programs = json::array();
    for (const auto& [what, value] : run.machine) machine.push_back({what, value});
    for (const ProgramRun& each : run.programs)
        programs.push_back({{"name", each.name},
                            {"failure", each.failure},
                            {"usage", to_json(each.usage)},
                            {"noise_after", to_json(each.after)},
                            {"result", json::parse(each.result.text())}});
    return json{{"form", 1},           {"commit", run.commit},
                {"when", run.when},    {"setting", run.setting},
                {"machine", machine},  {"noise_before", to_json(run.before)},
                {"programs", programs}}
        .dump(1, ' ', false, json::error_handler_t::replace);
}

std::expected<Run, std::string> parse_run(std::string_view text, const std::string& name) {
    try {
        const json j = json::parse(text);
        if (j.at("form") != 1)
            return std::unexpected(name + " is of another form of figures than this report reads");
        Run run{j.at("commit"), j.at("when"), j.at("setting")};
        for (const json& pair : j.at("machine")) run.machine.emplace_back(pair.at(0), pair.at(1));
        run.before = noise(j.at("noise_before"));
        for (const json& each : j.at("programs")) {
            ProgramRun program{each.at("name"), each.at("failure")};
            auto result = parse_result(each.at("result").dump(), name + ", " + program.name);
            if (!result) return std::unexpected(result.error());
            program.result = std::move(*result);
            program.usage = usage(each.at("usage"));
            program.after = noise(each.at("noise_after"));
            run.programs.push_back(std::move(program));
        }
        return run;
    } catch (const json::exception& wrong) {
        return std::unexpected(name + " is no run of figures: " + wrong.what());
    }
}

Score score(const Run& run) {
    Score score;
    score.programs = run.programs.size();
    for (const ProgramRun& program : run.programs) {
        score.failed += program.failure.empty() ? 0u : 1u;
        score.goals += program.result.goals.size();
        score.statements += program.result.statements.size();
        for (const Goal& goal : program.result.goals) score.held += goal.held() ? 1u : 0u;
        for (const Statement& each : program.result.statements) score.true_ones += each.held ? 1u : 0u;
    }
    return score;
}

} // namespace tappet::figures
