// A run as its merged JSON.
#include "tests/figures/report/run.hpp"

#include <nlohmann/json.hpp>

namespace tappet::figures {

using nlohmann::json;

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Usage, seconds, busy_percent, steal_percent, switches_per_second,
                                   interrupts_per_second)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Noise, work_us, spread_percent, worst_percent, gaps_per_second,
                                   longest_gap_us, lost_percent)

std::string merged(const Run& run) {
    json programs = json::array();
    for (const ProgramRun& each : run.programs)
        programs.push_back({{"name", each.name},
                            {"failure", each.failure},
                            {"usage", each.usage},
                            {"noise_after", each.after},
                            {"result", json::parse(each.result.text())}});
    return json{{"form", 1},
                {"commit", run.commit},
                {"when", run.when},
                {"setting", run.setting},
                {"machine", run.machine},
                {"noise_before", run.before},
                {"programs", programs}}
        .dump(1, ' ', false, json::error_handler_t::replace);
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
