// The thesis' statements on its experiments, each with its decisive measurement.
#include "tests/figures/experiments/findings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>

namespace tappet::experiments {

using figures::Samples;
using figures::Statement;

namespace {

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, std::abs(value) < 10 ? "%.2f" : "%.0f", value);
    return text;
}

/// p99 of the deviation of a period from that of the row.
double jitter_us(const TaskResult& task) {
    Samples deviations;
    for (const double period : task.periods.values()) deviations.add(std::abs(period - task.period_us));
    return deviations.quantile(0.99);
}

double share_near(const Samples& samples, double centre, double tolerance) {
    if (samples.empty()) return 0;
    const auto near = std::ranges::count_if(
        samples.values(), [&](double value) { return std::abs(value - centre) <= tolerance; });
    return static_cast<double>(near) / static_cast<double>(samples.count());
}

/// Collects the results of each application; a statement is true when it holds for all that were run.
class Verdict {
public:
    explicit Verdict(std::string text) : text_{std::move(text)} {}
    void add(bool holds, const std::string& seen) {
        held_ &= holds;
        measured_ += (measured_.empty() ? "" : "; ") + seen;
    }
    void conclude(std::vector<Statement>& into) const {
        if (!measured_.empty()) into.push_back({text_, held_, measured_});
    }

private:
    std::string text_;
    bool held_ = true;
    std::string measured_{};
};

using Of = const TaskResult&;
/// Visits each application in which this task ran in this setting.
void each_application(const Findings& findings, Setting setting, std::string_view task,
                      const std::function<void(const std::string&, Of)>& look) {
    for (const char* application : application_names)
        if (const TaskResult* found = findings.find(application, setting, task)) look(application, *found);
}

void judge_periods(const Findings& findings, std::vector<Statement>& into) {
    Verdict stable{
        "4.2.3: whatever lower priorities are added, the period of the highest remains stable (99 % of "
        "its deviations at most half as large again as of a bare thread alone)"};
    each_application(findings, Setting::none, "high", [&](const std::string& name, Of task) {
        const TaskResult* bare = findings.find_bare(name);
        if (bare == nullptr) return;
        stable.add(jitter_us(task) <= 1.5 * jitter_us(*bare),
                   name + " " + number(jitter_us(task)) + " us, bare " + number(jitter_us(*bare)) + " us");
    });
    stable.conclude(into);

    Verdict grows{
        "4.2.3: the lower the priority, the larger the jitter of the period, by preemption (99 % of "
        "the deviations)"};
    for (const char* application : application_names) {
        const Experiment* experiment = findings.find(application, Setting::none);
        if (experiment == nullptr) continue;
        double before = 0;
        std::string seen = application;
        bool rises = true;
        std::size_t tasks = 0;
        for (const TaskResult& task : experiment->tasks) {
            if (!task.real_time) continue;
            rises &= tasks++ == 0 || jitter_us(task) > before;
            before = jitter_us(task);
            seen += " " + task.name + " " + number(before) + " us";
        }
        if (tasks > 1) grows.add(rises, seen);
    }
    grows.conclude(into);
}

/// Both tasks of the small application have the same load: the time of the highest is one step in the latency
/// of the low one.
void judge_peaks(const Findings& findings, std::vector<Statement>& into) {
    const TaskResult* high = findings.find("small", Setting::none, "high");
    const TaskResult* low = findings.find("small", Setting::none, "low");
    if (high == nullptr || low == nullptr) return;
    const double step = high->latencies.median();
    std::array<double, 4> share{}; // after 0, 1, 2 and 3 preemptions
    std::string seen = "load " + number(step) + " us";
    for (std::size_t i = 0; i < share.size(); ++i) {
        const double peak = static_cast<double>(i + 1) * step;
        share[i] = share_near(low->latencies, peak, step / 4);
        seen += ", near " + number(peak) + " us " + number(100 * share[i]) + " %";
    }
    const auto two_peaks = [&](std::size_t first) {
        return std::min(share[first], share[first + 1]) >= 0.01 && share[first] + share[first + 1] >= 0.9;
    };
    into.push_back(
        {"4.2.3: in the small application the latency of the low priority has two peaks, where it was "
         "preempted once (1 ms) and twice (1.5 ms); each at least 1 %, together 90 %",
         two_peaks(1), seen});
    into.push_back(
        {"4.2.3: preemption shows as two peaks of the low priority's latency that are one load of the "
         "highest apart; each at least 1 %, together 90 %",
         two_peaks(0) || two_peaks(1) || two_peaks(2), seen});
}

void judge_latencies(const Findings& findings, std::vector<Statement>& into) {
    Verdict steady{
        "4.2.3: without preemption latencies are highly deterministic: of the highest priority p99.9 "
        "is at most 1.1 times that of a bare thread alone"};
    each_application(findings, Setting::none, "high", [&](const std::string& name, Of task) {
        const TaskResult* bare = findings.find_bare(name);
        if (bare == nullptr || bare->latencies.empty()) return;
        const double ours = task.latencies.quantile(0.999), alone = bare->latencies.quantile(0.999);
        steady.add(ours <= 1.1 * alone, name + " " + number(ours) + " us, bare " + number(alone) +
                                            " us (medians " + number(task.latencies.median()) + " and " +
                                            number(bare->latencies.median()) + ")");
    });
    steady.conclude(into);
    judge_peaks(findings, into);

    Verdict met{"4.2.3: the loads are schedulable: no real-time activity missed a deadline in any setting"};
    for (const char* application : application_names) {
        std::uint64_t misses = 0, here = 0;
        for (const Experiment& experiment : findings.all())
            for (const TaskResult& task : experiment.tasks) {
                if (experiment.application != application || !task.real_time) continue;
                misses += task.misses;
                here += task.executions;
            }
        if (here == 0) continue;
        std::string seen =
            std::string{application} + " " + std::to_string(misses) + " of " + std::to_string(here);
        if (const TaskResult* bare = findings.find_bare(application))
            seen += " (a bare thread alone " + std::to_string(bare->misses) + " of " +
                    std::to_string(bare->executions) + ")";
        met.add(misses == 0, seen);
    }
    met.conclude(into);
}

using Look = std::function<double(const Samples&)>;
/// Compares ours with the mutex, for one task in one application.
void compare(Verdict& verdict, const Findings& findings, const char* application, const char* task,
             const Look& look, double factor) {
    const TaskResult* ours = findings.find(application, Setting::data, task);
    const TaskResult* locked = findings.find(application, Setting::locked, task);
    if (ours == nullptr || locked == nullptr || ours->exchanges.empty() || locked->exchanges.empty()) return;
    const double a = look(ours->exchanges), b = look(locked->exchanges);
    std::string seen =
        std::string{application} + " " + task + " " + number(a) + " ns, locks " + number(b) + " ns";
    const TaskResult* bare = findings.find(application, Setting::none, task);
    const bool has_buffers = std::string_view{application} == "large"; // the copies leave buffers out
    if (bare != nullptr && !bare->copies.empty() && !has_buffers)
        seen += ", bare copies " + number(look(bare->copies)) + " ns";
    verdict.add(a * factor <= b, seen);
}
const Look mean = [](const Samples& samples) { return samples.mean(); };
const Look median = [](const Samples& samples) { return samples.median(); };
const Look all_but_one_in_a_thousand = [](const Samples& samples) { return samples.quantile(0.999); };
const Look worst = [](const Samples& samples) { return samples.max(); };

void judge_exchange(const Findings& findings, std::vector<Statement>& into) {
    const auto one = [&](const char* text, const char* application, const char* task, const Look& look,
                         double factor) {
        Verdict verdict{text};
        compare(verdict, findings, application, task, look, factor);
        verdict.conclude(into);
    };
    one("4.4.4: in the minimal application the exchange without locks is faster on average", "minimal",
        "high", mean, 1);
    one("4.4.4: in the minimal application the exchange without locks is about three times as fast on "
        "average "
        "(at least 2.5)",
        "minimal", "high", mean, 2.5);
    one("4.4.4: in the minimal application the exchange without locks is faster in the median", "minimal",
        "high", median, 1);
    one("4.4.4: in the concurrent application the medium priority exchanges faster on average without locks",
        "concurrent", "medium", mean, 1);
    one("4.4.4: in the concurrent application the medium priority has a better worst case without locks",
        "concurrent", "medium", worst, 1);
    one("4.4.4: in the concurrent application the low priority's worst case is no longer without locks (10 "
        "%)",
        "concurrent", "low", worst, 1 / 1.1);

    Verdict faster{
        "4.4.4: exchange without locks is faster on average, for every priority in every application"};
    Verdict usually{
        "4.4.4: exchange without locks is faster in the median, for every priority in every application"};
    Verdict mostly{"4.4.4: exchange without locks has the better p99.9 for the highest priority"};
    Verdict bounded{"4.4.4: exchange without locks has the better worst case for the highest priority"};
    for (const char* application : application_names) {
        for (const char* task : {"high", "medium", "low", "very_low"})
            compare(faster, findings, application, task, mean, 1),
                compare(usually, findings, application, task, median, 1);
        compare(mostly, findings, application, "high", all_but_one_in_a_thousand, 1);
        compare(bounded, findings, application, "high", worst, 1);
    }
    faster.conclude(into);
    usually.conclude(into);
    mostly.conclude(into);
    bounded.conclude(into);
}

void judge_waiting(const Findings& findings, std::vector<Statement>& into) {
    Verdict never{
        "4.4.4: without locks the highest priority never waits: it gives the processor away at the end "
        "of its cycle only"};
    each_application(findings, Setting::data, "high", [&](const std::string& name, Of task) {
        never.add(task.blocked == 0, name + " " + std::to_string(task.blocked) + " times in " +
                                         std::to_string(task.executions) + " executions");
    });
    never.conclude(into);

    Verdict sometimes{"4.4.4: with locks the highest priority waits for lower ones"};
    Verdict oftener{"4.4.4: with each lower priority that is added the odds grow that it waits"};
    double before = -1;
    std::uint64_t waits = 0;
    int applications = 0;
    std::string seen;
    each_application(findings, Setting::locked, "high", [&](const std::string& name, Of task) {
        const auto waited = static_cast<double>(task.waited_for_locks);
        const double odds = 1e6 * waited / static_cast<double>(std::max<std::uint64_t>(1, task.executions));
        oftener.add(odds > before, name + " " + number(odds) + " in a million executions");
        before = odds;
        ++applications;
        waits += task.waited_for_locks;
        seen += (seen.empty() ? "" : "; ") + name + " " + std::to_string(task.waited_for_locks) +
                " times in " + std::to_string(task.executions);
    });
    if (!seen.empty()) sometimes.add(waits != 0, seen);
    sometimes.conclude(into);
    if (applications > 1) oftener.conclude(into);
}

/// The concurrent application's three priorities.
std::vector<const TaskResult*> concurrent_tasks(const Findings& findings, Setting setting) {
    std::vector<const TaskResult*> tasks;
    for (const char* name : {"high", "medium", "low"})
        if (const TaskResult* task = findings.find("concurrent", setting, name)) tasks.push_back(task);
    return tasks;
}

void judge_messages(const Findings& findings, Setting setting, std::vector<Statement>& into) {
    const bool commands = setting == Setting::commands;
    const std::vector<const TaskResult*> tasks = concurrent_tasks(findings, setting);
    if (tasks.empty()) return;
    const std::string section = commands ? "4.5.4: " : "4.6.4: ";
    const std::string act = commands ? "sending a command" : "emitting an event";

    Verdict order{section + act +
                  " takes the highest priority least on average, the others more by preemption"};
    double least = 0;
    for (const TaskResult* task : tasks) {
        if (task->sends.empty()) continue;
        if (task == tasks.front()) least = task->sends.mean();
        order.add(task->sends.mean() >= least, task->name + " " + number(task->sends.mean()) + " ns");
    }
    order.conclude(into);

    if (const Samples& sends = tasks.front()->sends; !sends.empty())
        into.push_back(
            {section + act +
                 " is very deterministic: of the highest priority p99.9 is at most 3 times the median",
             sends.quantile(0.999) <= 3 * sends.median(),
             "median " + number(sends.median()) + " ns, p99.9 " + number(sends.quantile(0.999)) +
                 " ns, worst " + number(sends.max()) + " ns"});

    Verdict load{section + "serving one or two takes 10 or 20 % of the load (medians, within 5 % of it)"};
    for (const TaskResult* task : tasks)
        for (const auto& [samples, times] :
             {std::pair{&task->one_served, 1}, std::pair{&task->two_served, 2}}) {
            if (samples->empty()) continue;
            const double ideal = task->load_us * 100 * times; // ns
            load.add(std::abs(samples->median() - ideal) <= 0.05 * ideal,
                     task->name + " " + std::to_string(times) + ": " + number(samples->median() / 1e3) +
                         " of " + number(ideal / 1e3) + " us");
        }
    load.conclude(into);

    if (const Samples& one = tasks.front()->one_served; !one.empty())
        into.push_back(
            {section + "the engine's processor adds no significant jitter: serving one, p99.9 of the highest "
                       "priority is at most 1.2 times the median",
             one.quantile(0.999) <= 1.2 * one.median(),
             "median " + number(one.median() / 1e3) + " us, p99.9 " + number(one.quantile(0.999) / 1e3) +
                 " us"});
}

} // namespace

std::vector<Statement> statements_of(const Findings& findings) {
    std::vector<Statement> statements;
    judge_periods(findings, statements);
    judge_latencies(findings, statements);
    judge_exchange(findings, statements);
    judge_waiting(findings, statements);
    judge_messages(findings, Setting::commands, statements);
    judge_messages(findings, Setting::events, statements);
    return statements;
}

} // namespace tappet::experiments
