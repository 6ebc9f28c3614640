// tappet-figures: runs the programs of figures and writes the report, or compares those of two builds.
// ci/figures builds and calls it.
#include "tests/figures/report/compare.hpp"
#include "tests/figures/report/options.hpp"
#include "tests/figures/report/page.hpp"
#include "tests/figures/report/programs.hpp"
#include "tests/figures/report/surroundings.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>

namespace {

using namespace tappet::figures;

constexpr int all_well = 0, got_slower = 1, a_program_failed = 1, wrong_option = 2, not_run = 3;

int refuse(const std::string& why, int code) {
    std::cerr << "ci/figures: " << why << '\n';
    return code;
}

void say(const std::string& words) {
    static const auto begin = std::chrono::steady_clock::now();
    const auto seconds =
        std::chrono::duration_cast<std::chrono::seconds>(std::chrono::steady_clock::now() - begin);
    std::printf("[%4ds] %s\n", static_cast<int>(seconds.count()), words.c_str());
    std::fflush(stdout);
}

bool save(const std::string& path, const std::string& text) {
    std::ofstream file{path};
    file << text;
    return static_cast<bool>(file.flush());
}

double seconds_at_most(const ReportOptions& options) {
    if (options.limit > 0) return options.limit;
    return options.setting == "long" ? 3600 : options.setting == "smoke" ? 60 : 400;
}
std::vector<std::string> arguments(const ReportOptions& options) {
    std::vector<std::string> words;
    if (options.setting != "short") words.push_back("--" + options.setting);
    if (!options.counts) words.emplace_back("--no-counts");
    return words;
}

std::string told(const ProgramRun& run) {
    if (!run.failure.empty()) return "FAILED: " + run.failure.substr(0, run.failure.find('\n'));
    const auto held = std::ranges::count_if(run.result.goals, &Goal::held);
    return std::to_string(static_cast<int>(run.usage.seconds + 0.5)) + " s, " +
           std::to_string(run.result.figures.size()) + " figures" +
           (run.result.goals.empty() ? ""
                                     : ", " + std::to_string(held) + " of " +
                                           std::to_string(run.result.goals.size()) + " goals held");
}

int write_report(const Run& run, const std::string& output) {
    const std::string html = output + "/report.html", json = output + "/figures.json";
    const std::string all = merged(run);
    const auto shown = page(all);
    if (!shown) return refuse(shown.error(), not_run);
    if (!save(json, all) || !save(html, *shown)) return refuse("cannot write below " + output, not_run);
    std::cout << '\n' << summary_text(run) << "the page: " << html << "\nthe data: " << json << '\n';
    return score(run).failed == 0 ? all_well : a_program_failed;
}

int run_all(const ReportOptions& options, const std::vector<Program>& programs) {
    Run run{commit_of_tree(), local_time(), options.setting};
    run.machine = describe_machine();
    say("the machine's noise");
    run.before = measure_noise(0, options.setting == "smoke" ? 0.1 : 1);
    for (const Program& program : programs) {
        say("figures-" + program.name);
        const std::string place = options.output + "/" + program.name;
        run.programs.push_back(run_program(program, arguments(options), place + ".json", place + ".log",
                                           seconds_at_most(options)));
        run.programs.back().after = measure_noise(0, options.setting == "smoke" ? 0.1 : 0.4);
        say("figures-" + program.name + ": " + told(run.programs.back()));
    }
    return write_report(run, options.output);
}

/// Runs the programs of both builds alternately, round by round.
int compare_builds(const ReportOptions& options, const std::vector<Program>& now) {
    const auto found = find_programs(options.against);
    if (!found) return refuse(found.error(), not_run);
    std::vector<Round> rounds(options.rounds);
    std::size_t failures = 0;
    for (const Program& program : now) {
        const auto old = choose(*found, {program.only.empty() ? program.name : program.only});
        if (!old) {
            say("figures-" + program.name + " is not in " + options.against_name);
            continue;
        }
        for (std::size_t i = 0; i < rounds.size(); ++i) {
            // Instructions do not vary: they are counted once.
            std::vector<std::string> words = arguments(options);
            if (options.counts && i != 0) words.emplace_back("--no-counts");
            const auto run_one = [&](const Program& which, const char* name, std::vector<Result>& into) {
                const std::string place = options.output + "/" + which.name + "." + name;
                ProgramRun run =
                    run_program(which, words, place + ".json", place + ".log", seconds_at_most(options));
                if (!run.failure.empty()) {
                    say("figures-" + which.name + ", " + name + ": " + told(run));
                    ++failures;
                }
                into.push_back(std::move(run.result));
            };
            if (i % 2 == 0) run_one(old->front(), "before", rounds[i].before);
            run_one(program, "after", rounds[i].after);
            if (i % 2 != 0) run_one(old->front(), "before", rounds[i].before);
            say("figures-" + program.name + ": round " + std::to_string(i + 1) + " of " +
                std::to_string(options.rounds));
        }
    }
    const Comparison comparison = compare(rounds, options.margin_percent / 100);
    if (comparison.changes.empty())
        return refuse("the two commits have no row of a figure in common; nothing was compared", not_run);
    std::cout << '\n' << comparison_text(comparison, options.against_name, commit_of_tree());
    if (failures != 0)
        return refuse(std::to_string(failures) + " runs failed; their logs are in " + options.output,
                      not_run);
    return comparison.slower() ? got_slower : all_well;
}

} // namespace

int main(int argc, char** argv) {
    const auto options = read_report_options({argv + 1, argv + argc});
    if (!options) return refuse(options.error(), wrong_option);
    std::error_code none;
    std::filesystem::create_directories(options->output, none);
    const auto programs = find_programs(options->programs);
    if (!programs) return refuse(programs.error(), not_run);
    const auto chosen = choose(*programs, options->only);
    if (!chosen) return refuse(chosen.error(), wrong_option);
    end_on_signals();
    return options->against.empty() ? run_all(*options, *chosen) : compare_builds(*options, *chosen);
}
