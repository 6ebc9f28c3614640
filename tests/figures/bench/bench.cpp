// The reaction path through real drivers: boots the bench, where a machine and a bare program answer frames
// and edges in turns, and judges what they took.
#include "tests/figures/measure/candidates.hpp"
#include "tests/figures/measure/equivalence.hpp"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>

#include <unistd.h>

namespace {

using namespace tappet::figures;
namespace fs = std::filesystem;

constexpr double margin = 0.05;

struct Report {
    std::vector<PairOfBlocks> pairs{};
    std::size_t unanswered = 0;
};

/// What the guest wrote, by "can" and "gpio"; empty when it did not come to its end.
std::map<std::string, Report> boot(std::size_t pairs, const fs::path& folder) {
    const std::string file = (folder / "pairs").string(), log = (folder / "log").string();
    const std::string command = "'" TAPPET_BENCH "' --verbose --timeout 150 --can can0 --gpio-chip panel:8 "
                                "--set /proc/sys/kernel/sched_rt_runtime_us=-1 --file '" TAPPET_ANSWERING
                                "'=/bin/answering --collect '/tmp/pairs=" +
                                file + "' --run 'answering " + std::to_string(pairs) + " /tmp/pairs' >'" +
                                log + "' 2>&1";
    std::map<std::string, Report> told;
    if (std::system(command.c_str()) != 0) { // NOLINT: the words are the build's own
        std::cerr << "the bench did not come to its end:\n" << std::ifstream{log}.rdbuf() << '\n';
        return told;
    }
    std::ifstream lines{file};
    std::string what;
    for (double ours = 0, bare = 0; lines >> what >> ours >> bare;) {
        if (ours < 0 || bare < 0)
            ++told[what].unanswered;
        else
            told[what].pairs.push_back({{ours / 1000}, {bare / 1000}});
    }
    return told;
}

void judge(const std::string& id, const std::string& title, const Report& told, Result& result) {
    Samples ours, bare;
    for (const PairOfBlocks& pair : told.pairs) {
        ours.add(pair.ours.front());
        bare.add(pair.theirs.front());
    }
    result.figures.push_back(
        {.id = id,
         .title = title,
         .unit = "us",
         .source = "",
         .how = "one answer, seen from the other end of the wire; in turns in one boot; the guest's time is "
                "the instructions it executes: a ratio of times is one of instructions, those of the kernel "
                "included",
         .rows = {{"Tappet: driver, components, driver", Standing::ours, ours.summary(), {}},
                  {"bare: wait, read, write", Standing::floor, bare.summary(), {}}}});
    for (const auto& [q, name] : {std::pair{0.5, "median"}, std::pair{0.99, "p99"}}) {
        const Comparison found = compare(told.pairs, q, margin);
        char text[160];
        std::snprintf(text, sizeof text, "ratio %.3f, 90 %% interval %.3f to %.3f from %zu pairs: %s",
                      found.ratio, found.low, found.high, found.pairs, to_text(found.verdict()));
        result.statements.push_back({title + ": equivalent to a bare program within 5 % at " + name,
                                     found.verdict() == Verdict::equivalent, text});
    }
    result.statements.push_back({title + ": every request was answered", told.unanswered == 0,
                                 std::to_string(told.unanswered) + " were not"});
    result.plots.push_back({id,
                            title,
                            "request to answer [us]",
                            "answers",
                            true,
                            false,
                            true,
                            {histogram("Tappet", Standing::ours, ours, 100, 0.995),
                             histogram("bare", Standing::floor, bare, 100, 0.995)}});
}

} // namespace

int main(int argc, char** argv) {
    const Options options = read_options(argc, argv);
    Result result{.program = "bench", .setting = options.setting};
    if (options.setting == "smoke") {
        result.notes.emplace_back("nothing was booted in this setting");
        return finish(options, result);
    }
    const fs::path folder =
        fs::temp_directory_path() / ("tappet-bench-figures-" + std::to_string(::getpid()));
    fs::create_directories(folder);
    const auto told = boot(options.setting == "long"    ? 5000
                           : options.setting == "brief" ? 200
                                                        : 1000,
                           folder);
    fs::remove_all(folder);
    if (told.empty())
        result.notes.emplace_back(
            "the bench could not be booted here: the reaction through drivers is not known");
    if (const auto can = told.find("can"); can != told.end())
        judge("bench.reaction.can", "CAN frame in to CAN frame out", can->second, result);
    if (const auto gpio = told.find("gpio"); gpio != told.end())
        judge("bench.reaction.gpio", "GPIO edge in to GPIO edge out", gpio->second, result);
    return finish(options, result);
}
