// Rounds under google-benchmark, ratios round by round, and the goals.
#include "tests/figures/measure/candidates.hpp"

#include "tests/figures/measure/counts.hpp"
#include "tests/figures/measure/ticks.hpp"
#include "tests/figures/measure/undisturbed.hpp"

#include <benchmark/benchmark.h>

#include <condition_variable>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <map>
#include <mutex>
#include <thread>

namespace tappet::figures {

namespace {

/// What was measured of one candidate.
struct Rounds {
    const Candidate* candidate = nullptr;
    std::size_t batch = 0;
    std::vector<Samples> each = {};
};

constexpr int rounds_of_short = 9;
constexpr std::size_t samples_of_round = 400;
constexpr double longest_round_ns = 20e6; ///< of a candidate that is slow

void measure(benchmark::State& state, Rounds& rounds) {
    const std::size_t batch = rounds.batch;
    const auto prepare = [&] {
        if (rounds.candidate->prepare != nullptr) rounds.candidate->prepare(batch);
    };
    prepare();
    rounds.candidate->run(batch); // caches
    Samples samples;
    samples.reserve(samples_of_round);
    const double reading = ticks_of_reading();
    double spent = 0;
    while (state.KeepRunning()) {
        prepare();
        const std::uint64_t first = ticks();
        rounds.candidate->run(batch);
        const std::uint64_t last = ticks();
        const double took = static_cast<double>(last - first) - reading;
        if (spent > longest_round_ns) continue;
        samples.add(std::max(0.0, took * ns_per_tick() / static_cast<double>(batch)));
        spent += took * ns_per_tick();
    }
    rounds.each.push_back(std::move(samples));
    rest_after(spent);
}

double statistic_of(const Samples& samples, Statistic which) {
    return samples.quantile(which == Statistic::median ? 0.5 : which == Statistic::p99 ? 0.99 : 0.999);
}

using Measured = std::map<std::string, Rounds>;

Goal judge(const RatioGoal& plan, const Measured& measured) {
    const auto find = [&](const std::string& name) -> const Rounds& {
        const auto found = measured.find(plan.group + "/" + name);
        if (found == measured.end()) {
            std::cerr << "goal \"" << plan.text << "\": group " << plan.group << " has no candidate \""
                      << name << "\"\n";
            std::exit(2);
        }
        return found->second;
    };
    const Rounds& ours = find(plan.ours);
    Samples ratios;
    for (std::size_t round = 0; round < ours.each.size(); ++round) {
        double of = 0;
        for (const std::string& name : plan.of) of += statistic_of(find(name).each.at(round), plan.statistic);
        ratios.add(statistic_of(ours.each[round], plan.statistic) / of);
    }
    Goal goal{plan.text, plan.times, ratios.median(), "x", plan.group + ": " + plan.ours + " / "};
    for (std::size_t i = 0; i < plan.of.size(); ++i) goal.detail += (i == 0 ? "" : " + ") + plan.of[i];
    return goal;
}

/// As long as a process has one thread, the C library takes locks without atomic operations; a machine has
/// several.
class SecondThread {
public:
    SecondThread()
        : sleeps_{[this] {
              std::unique_lock<std::mutex> locked{mutex_};
              ended_.wait(locked, [this] { return is_over_; });
          }} {}
    ~SecondThread() {
        {
            const std::lock_guard<std::mutex> locked{mutex_};
            is_over_ = true;
        }
        ended_.notify_one();
        sleeps_.join();
    }
    SecondThread(const SecondThread&) = delete;
    SecondThread& operator=(const SecondThread&) = delete;

private:
    std::mutex mutex_{};
    std::condition_variable ended_{};
    bool is_over_ = false;
    std::thread sleeps_;
};

/// The program's own tables say everything.
class Silent : public benchmark::BenchmarkReporter {
public:
    bool ReportContext(const Context&) override { return true; }
    void ReportRuns(const std::vector<Run>&) override {}
};

} // namespace

Options read_options(int argc, char** argv) {
    Options options;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        const bool follows = i + 1 < argc;
        if (word == "--json" && follows)
            options.json = argv[++i];
        else if (word == "--only" && follows)
            options.only = argv[++i];
        else if (word == "--long" || word == "--brief" || word == "--smoke")
            options.setting = word.substr(2);
        else if (word == "--no-counts")
            options.counts = false;
        else {
            std::cerr
                << argv[0] << ": '" << word
                << "' is no option, or lacks its value; there are --json FILE, --long, --brief, --smoke, "
                << "--only TEXT, --no-counts\n";
            std::exit(2);
        }
    }
    if (options.setting == "smoke") options.counts = false;
    return options;
}

void run_candidates(const Options& options, char** argv, const std::vector<Group>& groups,
                    const std::vector<RatioGoal>& goals, Result& result) {
    std::vector<const Group*> wanted;
    for (const Group& group : groups)
        if (options.only.empty() || group.id.find(options.only) != std::string::npos)
            wanted.push_back(&group);
    const SecondThread second;
    leave_if_counting(wanted);

    const int rounds = std::max(3, static_cast<int>(rounds_of_short * std::min(3.0, options.scale())));
    const auto samples =
        std::max<std::size_t>(20, static_cast<std::size_t>(samples_of_round * options.scale()));
    Measured measured;
    for (const Group* group : wanted)
        for (const Candidate& candidate : group->candidates) {
            const std::string name = group->id + "/" + candidate.name;
            Rounds& here = measured[name];
            here.candidate = &candidate;
            here.batch = group->batch;
            benchmark::RegisterBenchmark(name.c_str(),
                                         [&here](benchmark::State& state) { measure(state, here); })
                ->Iterations(static_cast<std::int64_t>(samples))
                ->Repetitions(rounds);
        }
    int words = 2;
    std::string program = argv[0], interleaved = "--benchmark_enable_random_interleaving=true";
    char* arguments[] = {program.data(), interleaved.data(), nullptr};
    benchmark::Initialize(&words, arguments);
    {
        const Undisturbed quiet{0};
        if (!quiet.refused().empty()) result.notes.push_back("the system refused: " + quiet.refused());
        Silent silent;
        if (!wanted.empty()) benchmark::RunSpecifiedBenchmarks(&silent);
        benchmark::ClearRegisteredBenchmarks();
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
    }
    for (const RatioGoal& goal : goals)
        for (const Group* group : wanted)
            if (group->id == goal.group) result.goals.push_back(judge(goal, measured));
}

int finish(const Options& options, const Result& result) {
    result.print();
    if (options.json.empty()) return 0;
    const std::string why_not = result.write(options.json);
    if (!why_not.empty()) std::cerr << why_not << '\n';
    return why_not.empty() ? 0 : 1;
}

} // namespace tappet::figures
