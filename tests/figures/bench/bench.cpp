// The reaction path through real drivers: boots the bench, where a machine and a bare program answer frames
// and edges in turns, and judges their times; and a loop beside a wire that is flooded by turns.
#include "tests/figures/measure/candidates.hpp"
#include "tests/figures/measure/equivalence.hpp"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <optional>
#include <sstream>

#include <unistd.h>

namespace {

using namespace tappet::figures;
namespace fs = std::filesystem;

constexpr double margin = 0.05;
/// Bound on p99 with flood over p99 without: a processor that does not idle must first leave another thread
/// and put away that one's frame.
constexpr double disturbed_above = 1.25;

struct Report {
    std::vector<PairOfBlocks> pairs{};
    std::size_t unanswered = 0;
};

/// The lines that a program wrote in the guest; nothing when it did not finish.
std::optional<std::ifstream> boot(const std::string& box, const std::string& words, const fs::path& folder) {
    const std::string file = (folder / "pairs").string(), log = (folder / "log").string();
    const std::string command = "'" TAPPET_BENCH "' --verbose --timeout 150 --can can0 "
                                "--set /proc/sys/kernel/sched_rt_runtime_us=-1 " +
                                box + " --collect '/tmp/pairs=" + file + "' --run '" + words + "' >'" + log +
                                "' 2>&1";
    if (std::system(command.c_str()) == 0)
        return std::ifstream{file}; // NOLINT: the words are the build's own
    std::cerr << "the bench did not finish:\n" << std::ifstream{log}.rdbuf() << '\n';
    return std::nullopt;
}

/// The guest's measurements, by "can" and "gpio".
std::map<std::string, Report> answered(std::size_t pairs, const fs::path& folder) {
    std::map<std::string, Report> told;
    auto lines = boot("--gpio-chip panel:8 --file '" TAPPET_ANSWERING "'=/bin/answering",
                      "answering " + std::to_string(pairs) + " /tmp/pairs", folder);
    std::string what;
    for (double ours = 0, bare = 0; lines && *lines >> what >> ours >> bare;) {
        if (ours < 0 || bare < 0)
            ++told[what].unanswered;
        else
            told[what].pairs.push_back({{ours / 1000}, {bare / 1000}});
    }
    return told;
}

/// By the kind of flood: the loop's responses in us, each block with flood beside one without.
std::map<std::string, std::vector<PairOfBlocks>> flooded(std::size_t pairs, const fs::path& folder) {
    std::map<std::string, std::vector<PairOfBlocks>> told;
    // The exit code says whether the loop was disturbed; the figure says the same.
    auto lines =
        boot("--tool sh --file '" TAPPET_FLOODED "'=/bin/flooded",
             "sh -c \"flooded right " + std::to_string(pairs) + " /tmp/pairs || [ $? = 1 ]\"", folder);
    for (std::string line; lines && std::getline(*lines, line);) {
        std::istringstream rest{line};
        std::string kind, how;
        rest >> kind >> how;
        if (how == "flooded") told[kind].emplace_back();
        if (told[kind].empty()) continue;
        PairOfBlocks& pair = told[kind].back();
        for (double ns = 0; rest >> ns;) (how == "flooded" ? pair.ours : pair.theirs).push_back(ns / 1000);
    }
    return told;
}

void judge(const std::string& id, const std::string& title, const Report& told, Result& result) {
    const Samples ours = all_of(told.pairs, &PairOfBlocks::ours),
                  bare = all_of(told.pairs, &PairOfBlocks::theirs);
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
        result.statements.push_back({title + ": equivalent to a bare program within 5 % at " + name,
                                     found.verdict() == Verdict::equivalent, found.text()});
    }
    result.statements.push_back({title + ": every request was answered", told.unanswered == 0,
                                 std::to_string(told.unanswered) + " were not"});
    result.plots.push_back(histogram_plot(id, title, "request to answer [us]", "answers",
                                          {histogram("Tappet", Standing::ours, ours, 100, 0.995),
                                           histogram("bare", Standing::floor, bare, 100, 0.995)}));
}

void judge_flood(const std::string& kind, const std::string& title, const std::vector<PairOfBlocks>& pairs,
                 Result& result) {
    const Samples with = all_of(pairs, &PairOfBlocks::ours), without = all_of(pairs, &PairOfBlocks::theirs);
    const std::string id = "bench.flood." + kind;
    result.figures.push_back(
        {.id = id,
         .title = "a loop that is more urgent than its wire, from its release to its end, beside " + title,
         .unit = "us",
         .source = "thesis 2.4",
         .how = "one period of 1 ms; blocks of flood and of quiet in turns in one boot; the guest's time is "
                "the instructions it executes",
         .rows = {{"flooded", Standing::ours, with.summary(), {}},
                  {"quiet", Standing::floor, without.summary(), {}}}});
    const Comparison found = compare(pairs, 0.99, margin);
    char text[160];
    std::snprintf(text, sizeof text, "%s at p99, 90 %% interval %.3f to %.3f from %zu pairs of blocks",
                  id.c_str(), found.low, found.high, found.pairs);
    result.goals.push_back({"a loop above its wire, beside " + title + ": p99 <= 1.25 of that in quiet",
                            disturbed_above, found.ratio, "x", text});
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
    const auto wanted = [&](const char* id) {
        return options.only.empty() || std::string{id}.contains(options.only) || options.only.starts_with(id);
    };
    const std::size_t pairs = options.setting == "long" ? 5000 : options.setting == "brief" ? 200 : 1000;
    const auto told = wanted("bench.reaction") ? answered(pairs, folder) : std::map<std::string, Report>{};
    const auto floods = wanted("bench.flood") ? flooded(pairs / 50, folder)
                                              : std::map<std::string, std::vector<PairOfBlocks>>{};
    fs::remove_all(folder);
    for (const auto& [kind, title] :
         {std::pair{"at_its_rate", "a wire full of the other machine's frames"},
          {"of_the_other", "frames of the other machine, as fast as the kernel takes them"},
          {"of_ours", "a babbler with this machine's own identifiers"},
          {"of_any", "frames of any identifier, as fast as the kernel takes them"}})
        if (const auto flood = floods.find(kind); flood != floods.end())
            judge_flood(kind, title, flood->second, result);
    if (wanted("bench.flood") && floods.empty())
        result.notes.emplace_back(
            "the bench could not be booted here: what a flooded wire does is not known");
    if (wanted("bench.reaction") && told.empty())
        result.notes.emplace_back(
            "the bench could not be booted here: the reaction through drivers is not known");
    if (const auto can = told.find("can"); can != told.end())
        judge("bench.reaction.can", "CAN frame in to CAN frame out", can->second, result);
    if (const auto gpio = told.find("gpio"); gpio != told.end())
        judge("bench.reaction.gpio", "GPIO edge in to GPIO edge out", gpio->second, result);
    return finish(options, result);
}
