// Rounds in turns, ratios round by round, and the goals.
#include "tests/figures/measure/candidates.hpp"

#include "tests/figures/measure/ticks.hpp"
#include "tests/figures/measure/undisturbed.hpp"

#include <algorithm>
#include <condition_variable>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <mutex>
#include <random>
#include <thread>

#include <unistd.h>
#include <valgrind/callgrind.h>

namespace tappet::figures {

namespace {

/// The measurements of one candidate.
struct Rounds {
    const Candidate* candidate = nullptr;
    std::size_t batch = 0;
    std::vector<Samples> each = {};
};

constexpr double rounds_of_short = 9;
constexpr std::size_t samples_of_round = 400;
constexpr double longest_round_ns = 20e6; ///< for a slow candidate

/// Measures one round of it.
void measure(Rounds& rounds, std::size_t wanted) {
    const std::size_t batch = rounds.batch;
    const auto prepare = [&] {
        if (rounds.candidate->prepare != nullptr) rounds.candidate->prepare(batch);
    };
    prepare();
    rounds.candidate->run(batch); // warms the caches
    Samples samples;
    samples.reserve(wanted);
    const double reading = ticks_of_reading();
    double spent = 0;
    for (std::size_t sample = 0; sample < wanted && spent <= longest_round_ns; ++sample) {
        prepare();
        const std::uint64_t first = ticks();
        rounds.candidate->run(batch);
        const std::uint64_t last = ticks();
        const double took = static_cast<double>(last - first) - reading;
        samples.add(std::max(0.0, took * ns_per_tick() / static_cast<double>(batch)));
        spent += took * ns_per_tick();
    }
    rounds.each.push_back(std::move(samples));
    rest_after(spent);
}

using Measured = std::map<std::string, Rounds>;

Goal judge(const std::string& group, const RatioGoal& plan, const Measured& measured) {
    const auto find = [&](const std::string& name) -> const Rounds& {
        const auto found = measured.find(group + "/" + name);
        if (found == measured.end()) {
            std::cerr << "goal \"" << plan.text << "\": group " << group << " has no candidate \"" << name
                      << "\"\n";
            std::exit(2);
        }
        return found->second;
    };
    const Rounds& ours = find(plan.ours);
    Samples ratios;
    for (std::size_t round = 0; round < ours.each.size(); ++round) {
        double of = 0;
        for (const std::string& name : plan.of) of += find(name).each.at(round).median();
        ratios.add(ours.each[round].median() / of);
    }
    Goal goal{plan.text, plan.times, ratios.median(), "x", group + ": " + plan.ours + " / "};
    for (std::size_t i = 0; i < plan.of.size(); ++i) goal.detail += (i == 0 ? "" : " + ") + plan.of[i];
    return goal;
}

// ---- instructions

constexpr const char* told_to_count = "TAPPET_FIGURES_COUNT";
constexpr std::size_t operations = 2000;

/// When this process runs under callgrind: runs and counts each candidate, and ends the process.
void leave_if_counting(const std::vector<const Group*>& groups) {
    if (!counting()) return;
    for (const Group* group : groups)
        for (const Candidate& candidate : group->candidates) {
            const std::size_t times = candidate.prepare == nullptr ? operations : group->batch;
            const std::size_t rounds = operations / times;
            const std::string name = std::to_string(rounds * times) + " " + group->id + "/" + candidate.name;
            if (candidate.prepare != nullptr) candidate.prepare(times);
            candidate.run(times);
            CALLGRIND_ZERO_STATS;
            for (std::size_t round = 0; round < rounds; ++round) {
                if (candidate.prepare != nullptr) {
                    CALLGRIND_TOGGLE_COLLECT;
                    candidate.prepare(times);
                    CALLGRIND_TOGGLE_COLLECT;
                }
                candidate.run(times);
            }
            CALLGRIND_DUMP_STATS_AT(name.c_str());
        }
    std::_Exit(0);
}

/// Instructions of one operation, by "group/candidate": the program starts itself a second time under
/// callgrind, which dumps its counters after each candidate. Empty when valgrind is not installed.
std::map<std::string, double> count_instructions(const char* program, const std::string& only) {
    std::map<std::string, double> counts;
    const std::filesystem::path place =
        std::filesystem::temp_directory_path() / ("tappet-counts-" + std::to_string(::getpid()));
    std::filesystem::create_directories(place);
    const std::string command =
        std::string{told_to_count} + "=1 valgrind --tool=callgrind --callgrind-out-file='" +
        (place / "out").string() + "' '" + program + "'" + (only.empty() ? "" : " --only '" + only + "'") +
        " >'" + (place / "log").string() + "' 2>&1";
    if (std::system(command.c_str()) != 0)
        std::cerr << "instructions were not counted; is valgrind installed? The log:\n"
                  << std::ifstream{place / "log"}.rdbuf() << '\n';
    else
        for (const auto& entry : std::filesystem::directory_iterator{place}) {
            std::ifstream file{entry.path()};
            constexpr std::string_view trigger = "desc: Trigger: Client Request: ", totals = "totals: ";
            std::string name;
            double counted = 1;
            for (std::string line; std::getline(file, line);)
                if (line.starts_with(trigger)) {
                    counted = std::atof(line.c_str() + trigger.size());
                    name = line.substr(line.find(' ', trigger.size()) + 1);
                } else if (line.starts_with(totals) && !name.empty()) {
                    counts[name] = std::atof(line.c_str() + totals.size()) / counted;
                }
        }
    std::filesystem::remove_all(place);
    return counts;
}

} // namespace

bool counting() { return std::getenv(told_to_count) != nullptr; }

Options read_options(int argc, char** argv, const std::map<std::string, std::string*>& own) {
    Options options;
    std::map<std::string, std::string*> valued{{"--json", &options.json}, {"--only", &options.only}};
    valued.insert(own.begin(), own.end());
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if (const auto found = valued.find(word); found != valued.end() && i + 1 < argc)
            *found->second = argv[++i];
        else if (word == "--long" || word == "--brief" || word == "--smoke")
            options.setting = word.substr(2);
        else if (word == "--no-counts")
            options.counts = false;
        else {
            std::cerr
                << argv[0] << ": '" << word
                << "' is no option, or lacks its value; there are --json FILE, --long, --brief, --smoke, "
                << "--only TEXT, --no-counts";
            for (const auto& [name, value] : own) std::cerr << ", " << name << " VALUE";
            std::cerr << '\n';
            std::exit(2);
        }
    }
    if (options.setting == "smoke") options.counts = false;
    return options;
}

void run_candidates(const Options& options, char** argv, const std::vector<Group>& groups, Result& result) {
    std::vector<const Group*> wanted;
    for (const Group& group : groups)
        if (options.wants(group.id)) wanted.push_back(&group);
    // As long as a process has one thread, the C library takes locks without atomic operations; a machine has
    // several.
    const std::jthread second{[](const std::stop_token& over) {
        std::mutex mutex;
        std::unique_lock locked{mutex};
        std::condition_variable_any{}.wait(locked, over, [] { return false; });
    }};
    leave_if_counting(wanted);

    const auto rounds =
        static_cast<std::size_t>(std::max(3.0, rounds_of_short * std::min(3.0, options.scale())));
    const auto samples =
        std::max<std::size_t>(20, static_cast<std::size_t>(samples_of_round * options.scale()));
    Measured measured;
    std::vector<Rounds*> turns;
    for (const Group* group : wanted)
        for (const Candidate& candidate : group->candidates) {
            Rounds& here = measured[group->id + "/" + candidate.name];
            here = {&candidate, group->batch};
            turns.insert(turns.end(), rounds, &here);
        }
    std::ranges::shuffle(turns, std::minstd_rand{std::random_device{}()});
    {
        const Undisturbed quiet{0};
        if (!quiet.refused().empty()) result.notes.push_back("the system refused: " + quiet.refused());
        for (Rounds* each : turns) measure(*each, samples);
    }

    const std::map<std::string, double> counts = options.counts && !wanted.empty()
                                                     ? count_instructions(argv[0], options.only)
                                                     : std::map<std::string, double>{};
    result.setting = options.setting;
    for (const Group* group : wanted) {
        Figure figure{group->id,
                      group->title,
                      "ns",
                      group->source,
                      "one sample: the mean of " + std::to_string(group->batch) + " in a row",
                      {}};
        for (const Candidate& candidate : group->candidates) {
            const std::string name = group->id + "/" + candidate.name;
            Samples all;
            for (const Samples& round : measured[name].each) all.add(round);
            Row row{candidate.name, candidate.role, all.summary()};
            if (const auto found = counts.find(name); found != counts.end()) row.instructions = found->second;
            figure.rows.push_back(row);
        }
        result.figures.push_back(figure);
        for (const RatioGoal& goal : group->goals) result.goals.push_back(judge(group->id, goal, measured));
    }
}

int finish(const Options& options, const Result& result) {
    result.print();
    if (options.json.empty()) return 0;
    const std::string why_not = result.write(options.json);
    if (!why_not.empty()) std::cerr << why_not << '\n';
    return why_not.empty() ? 0 : 1;
}

} // namespace tappet::figures
