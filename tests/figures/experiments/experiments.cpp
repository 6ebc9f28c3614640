// figures-experiments: four applications in five settings, as the thesis validates its design. Words in
// addition to those of every program of figures:
//     --seconds S            of each application in each setting; the thesis: 300
//     --application NAME     one of minimal, small, concurrent, large
//     --setting NAME         one of none, locked, data, commands, events
//     --histograms DIRECTORY one file for each task of each application in each setting, as the thesis kept
//     them
#include "tests/figures/experiments/disturbance.hpp"
#include "tests/figures/experiments/findings.hpp"
#include "tests/figures/measure/candidates.hpp"
#include "tests/figures/measure/ticks.hpp"
#include "tests/figures/measure/undisturbed.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <thread>

#include <sched.h>

namespace {

using namespace tappet;
using namespace tappet::experiments;

struct Wanted {
    std::string seconds = {}; ///< empty: depends on the setting
    std::string application = {};
    std::string setting = {};
    std::string histograms = {};
};

[[noreturn]] void refuse(const std::string& sentence) {
    std::cerr << "figures-experiments: " << sentence << '\n';
    std::exit(2);
}

double seconds_of(const std::string& word) {
    const double seconds = std::atof(word.c_str());
    if (!(seconds > 0 && seconds <= 3600)) refuse("--seconds " + word + " is no time between 0 and 3600 s");
    return seconds;
}
void refuse_unknown(const Wanted& wanted) {
    const auto all = applications();
    if (!wanted.application.empty() &&
        std::ranges::find(all, wanted.application, &Application::name) == all.end())
        refuse("there is no application \"" + wanted.application +
               "\"; there are minimal, small, concurrent, large");
    if (!wanted.setting.empty() && std::ranges::find(setting_names, wanted.setting) == setting_names.end())
        refuse("there is no setting \"" + wanted.setting +
               "\"; there are none, locked, data, commands, events");
}

/// Binds this process to the last processor that it may use, and returns it.
int take_one_processor() {
    cpu_set_t all;
    CPU_ZERO(&all);
    if (sched_getaffinity(0, sizeof all, &all) != 0) return -1;
    int last = -1;
    for (int i = 0; i < CPU_SETSIZE; ++i)
        if (CPU_ISSET(static_cast<std::size_t>(i), &all)) last = i;
    return last;
}
void stay_on(int processor) {
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(static_cast<std::size_t>(processor), &one);
    if (sched_setaffinity(0, sizeof one, &one) != 0)
        refuse("the system does not let it choose its processor");
}

/// Turns per nanosecond: the median of many short trials on this undisturbed thread.
double calibrate_load() {
    constexpr std::uint64_t turns = 50'000; // some 100 us: shorter than the usual gap between disturbances
    constexpr int trials = 201;
    figures::Samples samples;
    for (int i = 0; i < trials; ++i) {
        const std::uint64_t first = figures::ticks();
        turn(turns);
        const std::uint64_t last = figures::ticks();
        samples.add(static_cast<double>(turns) /
                    (static_cast<double>(last - first) * figures::ns_per_tick()));
    }
    return samples.median();
}

struct Part {
    const Application* application;
    Setting setting;
};

/// Returns whether figures whose id contains `only` need that application in that setting.
bool shows_in(const Application& application, Setting setting, const std::string& only) {
    const std::string id = "experiments." + std::string{application.name} + ".";
    const auto meets = [&](const char* what) {
        return (id + what).contains(only) || only.contains(id + what);
    };
    switch (setting) {
    case Setting::none:
        return meets("period") || meets("latency") || meets("exchange") || meets("command.send") ||
               meets("event.send");
    case Setting::locked:
    case Setting::data: return meets("exchange") || meets("period.data") || meets("latency.data");
    case Setting::commands: return meets("command") || meets("period.commands");
    case Setting::events: return meets("event") || meets("period.events");
    }
    return false;
}

std::vector<Part> parts_of(const Wanted& wanted, const std::string& only) {
    std::vector<Part> parts;
    for (const Application& application : applications())
        for (std::size_t s = 0; s < setting_names.size(); ++s) {
            const bool is_wanted = (wanted.application.empty() || wanted.application == application.name) &&
                                   (wanted.setting.empty() || wanted.setting == setting_names[s]) &&
                                   shows_in(application, static_cast<Setting>(s), only);
            if (is_wanted) parts.push_back({&application, static_cast<Setting>(s)});
        }
    return parts;
}

void add_notes(figures::Result& result, double seconds, int processor) {
    result.notes.push_back("each application ran " + std::to_string(seconds) +
                           " s in each setting, all activities on processor " + std::to_string(processor) +
                           "; the thesis ran each for 300 s (--seconds 300)");
    result.notes.push_back("averages and worst cases hold whatever interrupted the machine meanwhile; a bare "
                           "thread and bare copies, "
                           "which nothing of Tappet touches, stand beside them");
    result.notes.push_back("that the highest priority meets a lock held by a lower one is rare, some times "
                           "in 100000 executions: a "
                           "short run may see none");
    result.notes.push_back(
        "the load of the concurrent application is 0.55: that is what the thesis' periods and "
        "loads add up to, its table 4.1 says 0.65");
    result.notes.push_back(
        "an engine does not stamp an empty queue, so that serving nothing is not shown here; "
        "figures-dispatch has the empty engine step");
}

} // namespace

int main(int argc, char** argv) {
    Wanted wanted;
    const figures::Options options = figures::read_options(argc, argv,
                                                           {{"--seconds", &wanted.seconds},
                                                            {"--application", &wanted.application},
                                                            {"--setting", &wanted.setting},
                                                            {"--histograms", &wanted.histograms}});
    refuse_unknown(wanted);
    constexpr double short_seconds = 2;
    const double seconds =
        wanted.seconds.empty() ? short_seconds * options.scale() : seconds_of(wanted.seconds);
    const std::vector<Part> parts = parts_of(wanted, options.only);
    if (parts.empty())
        refuse("no figure has \"" + options.only + "\" in its id; they begin with experiments.");

    figures::Result result{.program = "experiments", .setting = options.setting};
    const int processor = take_one_processor();
    Circumstances circumstances;
    // Repeated before each run: other programs change the speed of a processor.
    const auto calibrate = [&] {
        const figures::Undisturbed quiet{processor};
        circumstances.ns_per_tick = figures::ns_per_tick();
        circumstances.ticks_of_stamps = static_cast<std::uint64_t>(figures::ticks_of_reading());
        circumstances.turns_per_ns = calibrate_load();
        return quiet.refused();
    };
    if (const std::string refused = calibrate(); !refused.empty())
        result.notes.push_back("the system refused: " + refused);

    // In rounds, so that other programs affect all settings alike.
    const double rounds = std::clamp(std::round(seconds), 1.0, 10.0);
    const auto check = [](const Application& application, const std::string& why_not) {
        if (!why_not.empty()) refuse(std::string{application.name} + ": " + why_not);
    };
    Findings findings;
    for (int round = 0; round < static_cast<int>(rounds); ++round)
        for (const Part& part : parts) {
            const Application& application = *part.application;
            static_cast<void>(calibrate());
            stay_on(processor);
            const std::jthread disturbance{&disturb, static_cast<std::uint64_t>(round)};
            check(application, run_experiment(application, circumstances, seconds / rounds,
                                              findings.at(application.name, part.setting)));
            if (part.setting != Setting::none) continue;
            check(application,
                  run_bare(application, circumstances, seconds / rounds, findings.bare(application.name)));
        }

    if (!wanted.histograms.empty())
        if (const std::string why_not = write_histograms(findings, wanted.histograms); !why_not.empty())
            refuse(why_not);
    result.figures = figures_of(findings);
    std::erase_if(result.figures, [&](const figures::Figure& each) { return !options.wants(each.id); });
    result.plots = plots_of(findings);
    result.statements = statements_of(findings);
    add_notes(result, seconds, processor);
    return figures::finish(options, result);
}
