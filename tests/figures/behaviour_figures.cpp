// What a step, an event transition and a statement take against a switch written by hand, in the same run:
//     behaviour_figures                        the table of ratios
//     behaviour_figures --benchmark_filter=... as google-benchmark has it
#include "tests/figures/behaviours.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <string>

namespace {

using namespace tappet;
using namespace tappet::figures;

template <class Machine>
void drive_events(benchmark::State& state, Machine& machine) {
    std::int64_t now = 0;
    for (auto _ : state) benchmark::DoNotOptimize(machine.dispatch(0, at_ns(++now)));
}
template <class Machine>
void drive_steps(benchmark::State& state, Machine& machine) {
    std::int64_t now = 0;
    for (auto _ : state) {
        machine.step(at_ns(++now));
        benchmark::ClobberMemory();
    }
}

void event_hand_written(benchmark::State& state) {
    HandWritten machine;
    drive_events(state, machine);
}
void step_hand_written(benchmark::State& state) {
    HandWritten machine;
    drive_steps(state, machine);
}
template <std::size_t bytes, void (*bind)(Bound<bytes>&)>
void event_of(benchmark::State& state) {
    Bound<bytes> bound;
    bind(bound);
    drive_events(state, bound.machine);
}
template <std::size_t bytes, void (*bind)(Bound<bytes>&)>
void step_of(benchmark::State& state) {
    Bound<bytes> bound;
    bind(bound);
    drive_steps(state, bound.machine);
}

/// Statements in one run of the program.
constexpr std::int64_t statements_of_sums = [] { return 1000 * 9 + 1; }();

void statement_hand_written(benchmark::State& state) {
    for (auto _ : state) {
        HandWrittenSums sums;
        benchmark::DoNotOptimize(sums.run());
        benchmark::DoNotOptimize(sums.a);
    }
    state.SetItemsProcessed(state.iterations() * statements_of_sums);
}
void run_sums(benchmark::State& state, const ProgramCode& code) {
    alignas(data_alignment) std::array<std::byte, sums_bytes> data{};
    const ProgramTables& tables = tables_of(sums_script, 0);
    for (auto _ : state) {
        std::ranges::copy(tables.image, data.begin());
        ProgramContext context;
        context.data = data.data();
        context.position.node = tables.programs[0].first;
        std::uint32_t statements = 20'000;
        if (code.run(tables, context, statements) != ProgramReturn::ended) state.SkipWithError("did not end");
        benchmark::DoNotOptimize(data.data());
    }
    state.SetItemsProcessed(state.iterations() * statements_of_sums);
}
void statement_compiled(benchmark::State& state) { run_sums(state, native_code<sums_script>); }
void statement_loaded(benchmark::State& state) { run_sums(state, interpreted(tables_of(sums_script, 0))); }

/// Keeps the best time of each, and prints ratios behind the list.
class Ratios : public benchmark::ConsoleReporter {
public:
    void ReportRuns(const std::vector<Run>& runs) override {
        for (const Run& run : runs) {
            if (run.run_type != Run::RT_Iteration) continue;
            double& best = best_.try_emplace(run.run_name.function_name, 1e30).first->second;
            best = std::min(best, run.GetAdjustedCPUTime());
        }
        ConsoleReporter::ReportRuns(runs);
    }
    void print() const {
        std::printf("\n%-28s %10s %8s\n", "best of the repetitions", "ns", "ratio");
        for (const char* what : {"step", "event", "statement"}) {
            const auto hand = best_.find(std::string{what} + "/hand_written");
            if (hand == best_.end()) continue;
            const double per = std::string_view{what} == "statement" ? double{statements_of_sums} : 1.0;
            for (const auto& [name, time] : best_)
                if (name.starts_with(std::string{what} + "/"))
                    std::printf("%-28s %10.2f %8.2f\n", name.c_str(), time / per, time / hand->second);
        }
    }

private:
    std::map<std::string, double> best_;
};

void add(const char* name, void (*function)(benchmark::State&)) {
    benchmark::RegisterBenchmark(name, function)->Repetitions(7)->MinTime(0.05)->ReportAggregatesOnly(false);
}

} // namespace

int main(int count, char** words) {
    benchmark::Initialize(&count, words);
    if (benchmark::ReportUnrecognizedArguments(count, words)) return 2;
    add("step/hand_written", &step_hand_written);
    add("step/script_compiled", &step_of<swing_bytes, &bind_compiled>);
    add("step/script_loaded", &step_of<swing_bytes, &bind_loaded>);
    add("step/table_compiled", &step_of<16, &bind_table>);
    add("step/table_walked", &step_of<16, &bind_walked_table>);
    add("event/hand_written", &event_hand_written);
    add("event/script_compiled", &event_of<swing_bytes, &bind_compiled>);
    add("event/script_loaded", &event_of<swing_bytes, &bind_loaded>);
    add("event/table_compiled", &event_of<16, &bind_table>);
    add("event/table_walked", &event_of<16, &bind_walked_table>);
    add("statement/hand_written", &statement_hand_written);
    add("statement/compiled", &statement_compiled);
    add("statement/loaded", &statement_loaded);
    Ratios reporter;
    benchmark::RunSpecifiedBenchmarks(&reporter);
    reporter.print();
    return 0;
}
