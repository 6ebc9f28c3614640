// The cost of size: machines of 10 to 1000 components, a system of ten machines, and a jacquard head of 12288
// hooks.
#include "tests/figures/scale/scale.hpp"

#include <sstream>
#include <string>

namespace tappet::figures {

namespace {

constexpr double fast_pick_ns = 60e6; // a thousand picks a minute

void judge_picks(Result& result) {
    for (const Figure& figure : result.figures) {
        const Summary& pick = figure.rows.front().summary;
        std::ostringstream measured;
        measured << figure.title << ": " << pick.p999 / 1000 << " us at p99.9";
        result.statements.push_back(
            {"a pick of 12288 hooks takes the engines less than a thousandth of the time "
             "between two picks, at 1000 picks a minute",
             pick.p999 < fast_pick_ns / 1000, measured.str()});
    }
}

int measure(int argc, char** argv) {
    const Options options = read_options(argc, argv);
    Result result{.program = "scale", .setting = options.setting};
    run_candidates(options, argv, jacquard_groups(), result);
    judge_picks(result);
    const auto tools = read_toolset(TAPPET_SCALE_BUILD);
    if (!tools) result.notes.push_back(tools.error());
    if (tools && options.wants("scale.machine")) measure_growth(options, *tools, result);
    if (tools && options.wants("scale.system")) measure_system(options, *tools, result);
    return finish(options, result);
}

} // namespace

} // namespace tappet::figures

int main(int argc, char** argv) { return tappet::figures::measure(argc, argv); }
