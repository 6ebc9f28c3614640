// Makes tables and histograms of the samples.
#include "tests/figures/experiments/findings.hpp"

#include <algorithm>

namespace tappet::experiments {

using figures::Figure;
using figures::Plot;
using figures::Row;
using figures::Samples;
using figures::Standing;

Experiment& Findings::at(std::string_view application, Setting setting) {
    for (Experiment& each : experiments_)
        if (each.application == application && each.setting == setting) return each;
    return experiments_.emplace_back(Experiment{std::string{application}, setting});
}

const Experiment* Findings::find(std::string_view application, Setting setting) const {
    const auto found = std::ranges::find_if(experiments_, [&](const Experiment& each) {
        return each.application == application && each.setting == setting;
    });
    return found == experiments_.end() ? nullptr : &*found;
}

const TaskResult* Findings::find(std::string_view application, Setting setting, std::string_view task) const {
    const Experiment* const experiment = find(application, setting);
    if (experiment == nullptr) return nullptr;
    const auto found = std::ranges::find(experiment->tasks, task, &TaskResult::name);
    return found == experiment->tasks.end() ? nullptr : &*found;
}

TaskResult& Findings::bare(std::string_view application) { return bare_[std::string{application}]; }

const TaskResult* Findings::find_bare(std::string_view application) const {
    const auto found = bare_.find(application);
    return found == bare_.end() ? nullptr : &found->second;
}

namespace {

Row row_of(std::string name, Standing role, const Samples& samples) {
    return {std::move(name), role, samples.summary()};
}

using Select = Samples TaskResult::*;

/// A row for a value that is known without measuring.
Row stated(std::string name, double value) {
    return {std::move(name), Standing::floor, figures::single(value)};
}

void add(std::vector<Figure>& figures, Figure figure) {
    std::erase_if(figure.rows, [](const Row& row) { return row.summary.count == 0; });
    const bool has_ours = std::ranges::find(figure.rows, Standing::ours, &Row::role) != figure.rows.end();
    if (has_ours) figures.push_back(std::move(figure));
}

void add_times(std::vector<Figure>& figures, const Experiment& experiment, const TaskResult* bare) {
    const std::string id = "experiments." + experiment.application;
    Figure periods{id + ".period", experiment.application + ": periods, no communication", "us",
                   "thesis 4.2.3, figure 4.9", "from the beginning of one execution to that of the next"};
    Figure latencies{id + ".latency", experiment.application + ": latencies, no communication", "us",
                     "thesis 4.2.3, figure 4.10", "from the beginning of an execution to its end"};
    for (const TaskResult& task : experiment.tasks) {
        if (!task.real_time) continue;
        periods.rows.push_back(row_of(task.name, Standing::ours, task.periods));
        periods.rows.push_back(stated(task.name + ", as its row says", task.period_us));
        latencies.rows.push_back(row_of(task.name, Standing::ours, task.latencies));
        latencies.rows.push_back(stated(task.name + ", its load", task.load_us));
    }
    if (bare != nullptr) {
        periods.rows.push_back(row_of("high, a bare thread alone", Standing::floor, bare->periods));
        latencies.rows.push_back(row_of("high, a bare thread alone", Standing::floor, bare->latencies));
    }
    add(figures, std::move(periods));
    add(figures, std::move(latencies));
}

/// Periods or latencies of all priorities with communication, beside those without.
void add_with_communication(std::vector<Figure>& figures, const Findings& findings,
                            const std::string& application, Setting setting, Select samples) {
    const Experiment* const experiment = findings.find(application, setting);
    if (experiment == nullptr) return;
    const bool periods = samples == &TaskResult::periods;
    const std::string name{setting_names[static_cast<std::size_t>(setting)]};
    Figure figure{"experiments." + application + (periods ? ".period." : ".latency.") + name,
                  application + (periods ? ": periods with " : ": latencies with ") +
                      (setting == Setting::data ? "data flow" : name),
                  "us",
                  setting == Setting::data       ? "thesis 4.4.4"
                  : setting == Setting::commands ? "thesis 4.5.4"
                                                 : "thesis 4.6.4",
                  periods ? "from the beginning of one execution to that of the next"
                          : "from the beginning of an execution to its end"};
    for (const TaskResult& task : experiment->tasks) {
        if (!task.real_time) continue;
        figure.rows.push_back(row_of(task.name, Standing::ours, task.*samples));
        if (setting == Setting::data)
            if (const TaskResult* locked = findings.find(application, Setting::locked, task.name))
                figure.rows.push_back(row_of(task.name + ", mutex with priority inheritance", Standing::peer,
                                             locked->*samples));
        if (const TaskResult* none = findings.find(application, Setting::none, task.name))
            figure.rows.push_back(row_of(task.name + ", no communication", Standing::floor, none->*samples));
    }
    add(figures, std::move(figure));
}

void add_exchanges(std::vector<Figure>& figures, const Findings& findings, const std::string& application) {
    const Experiment* const ours = findings.find(application, Setting::data);
    if (ours == nullptr) return;
    for (const TaskResult& task : ours->tasks) {
        Figure figure{"experiments." + application + ".exchange." + task.name,
                      application + ": data flow of the task \"" + task.name + "\" in one execution", "ns",
                      "thesis 4.4.4", "all reads and writes of one execution, packets of 160 bytes"};
        figure.rows.push_back(row_of("connectors", Standing::ours, task.exchanges));
        if (const TaskResult* locked = findings.find(application, Setting::locked, task.name))
            figure.rows.push_back(
                row_of("mutex with priority inheritance", Standing::peer, locked->exchanges));
        if (const TaskResult* none = findings.find(application, Setting::none, task.name);
            none != nullptr && application != "large")
            figure.rows.push_back(
                row_of("the same packets, copied by one thread", Standing::floor, none->copies));
        add(figures, std::move(figure));
    }
}

void add_messages(std::vector<Figure>& figures, const Findings& findings, const Experiment& experiment) {
    const bool commands = experiment.setting == Setting::commands;
    const std::string id = "experiments." + experiment.application + (commands ? ".command" : ".event");
    const std::string what = experiment.application + (commands ? ": commands, " : ": events, ");
    const std::string source = commands ? "thesis 4.5.4" : "thesis 4.6.4";
    Figure sent{id + ".send", what + (commands ? "sending one" : "emitting one to two subscribers"), "ns",
                source, "of one, preemptions included"};
    Figure served{id + ".serve", what + "serving them after the execution", "us", source,
                  "from the end of the execution, taking them out of their queue included"};
    const Experiment* const none = findings.find(experiment.application, Setting::none);
    for (const TaskResult& task : experiment.tasks) {
        sent.rows.push_back(row_of(task.name, Standing::ours, task.sends));
        if (!task.real_time) continue;
        const auto in_us = [](const Samples& ns) {
            Samples us;
            for (const double value : ns.values()) us.add(value / 1e3);
            return us;
        };
        served.rows.push_back(row_of(task.name + ": one", Standing::ours, in_us(task.one_served)));
        served.rows.push_back(row_of(task.name + ": two", Standing::ours, in_us(task.two_served)));
        served.rows.push_back(stated(task.name + ": one, its load", task.load_us / 10));
        served.rows.push_back(stated(task.name + ": two, their load", task.load_us / 5));
    }
    if (none != nullptr)
        for (const TaskResult& task : none->tasks)
            sent.rows.push_back(row_of(task.name + (commands ? ", one bare message" : ", two bare messages"),
                                       Standing::floor, commands ? task.one_message : task.two_messages));
    add(figures, std::move(sent));
    add(figures, std::move(served));
}

/// One series for each real-time task of an experiment.
void add_plot(std::vector<Plot>& plots, const Experiment* experiment, std::string id, std::string title,
              std::string x, Select samples) {
    if (experiment == nullptr) return;
    Plot plot =
        figures::histogram_plot(std::move(id), std::move(title), std::move(x), "executions", {}, true);
    for (const TaskResult& task : experiment->tasks)
        if (task.real_time && !(task.*samples).empty())
            plot.series.push_back(figures::log_histogram(task.name, Standing::ours, task.*samples));
    if (!plot.series.empty()) plots.push_back(std::move(plot));
}

/// Deviations of periods from those of the rows: on one axis for all lengths.
void add_period_plot(std::vector<Plot>& plots, const Findings& findings, const std::string& application) {
    const Experiment* experiment = findings.find(application, Setting::none);
    if (experiment == nullptr) return;
    Plot plot = figures::histogram_plot(
        "experiments.figure.4.9." + application, "Figure 4.9: " + application + ", execution periods",
        "us from the period of the row, 99 % of the executions", "executions", {});
    for (const TaskResult& task : experiment->tasks) {
        if (!task.real_time || task.periods.empty()) continue;
        const double from = task.periods.quantile(0.005), to = task.periods.quantile(0.995);
        Samples shown;
        for (const double period : task.periods.values())
            if (period >= from && period <= to) shown.add(period - task.period_us);
        plot.series.push_back(figures::histogram(task.name, Standing::ours, shown));
    }
    if (!plot.series.empty()) plots.push_back(std::move(plot));
}

struct ExchangePlot {
    const char* number;
    const char* application;
    const char* task;
};
constexpr ExchangePlot exchange_plots[] = {{"4.14", "minimal", "high"},      {"4.15", "small", "high"},
                                           {"4.16", "small", "low"},         {"4.17", "concurrent", "high"},
                                           {"4.18", "concurrent", "medium"}, {"4.19", "concurrent", "low"},
                                           {"4.20", "large", "high"},        {"4.21", "large", "medium"},
                                           {"4.22", "large", "low"},         {"4.23", "large", "very_low"}};

void add_exchange_plot(std::vector<Plot>& plots, const Findings& findings, const ExchangePlot& wanted) {
    const TaskResult* ours = findings.find(wanted.application, Setting::data, wanted.task);
    const TaskResult* locked = findings.find(wanted.application, Setting::locked, wanted.task);
    if (ours == nullptr || locked == nullptr) return;
    plots.push_back(figures::histogram_plot(
        std::string{"experiments.figure."} + wanted.number,
        std::string{"Figure "} + wanted.number + ": " + wanted.application +
            ", communication of the task \"" + wanted.task + "\"",
        "ns in one execution", "executions",
        {figures::log_histogram("connectors", Standing::ours, ours->exchanges),
         figures::log_histogram("mutex with priority inheritance", Standing::peer, locked->exchanges)},
        true));
}

} // namespace

std::vector<Figure> figures_of(const Findings& findings) {
    std::vector<Figure> figures;
    for (const std::string application : application_names) {
        if (const Experiment* none = findings.find(application, Setting::none))
            add_times(figures, *none, findings.find_bare(application));
        add_exchanges(figures, findings, application);
        for (const Setting setting : {Setting::data, Setting::commands, Setting::events})
            add_with_communication(figures, findings, application, setting, &TaskResult::periods);
        // Commands and events run without the load: their latencies have no counterpart.
        add_with_communication(figures, findings, application, Setting::data, &TaskResult::latencies);
        for (const Setting setting : {Setting::commands, Setting::events})
            if (const Experiment* each = findings.find(application, setting))
                add_messages(figures, findings, *each);
    }
    return figures;
}

std::vector<Plot> plots_of(const Findings& findings) {
    std::vector<Plot> plots;
    for (const std::string application : application_names) {
        const Experiment* none = findings.find(application, Setting::none);
        add_period_plot(plots, findings, application);
        add_plot(plots, none, "experiments.figure.4.10." + application,
                 "Figure 4.10: " + application + ", latencies", "us", &TaskResult::latencies);
    }
    for (const ExchangePlot& each : exchange_plots) add_exchange_plot(plots, findings, each);
    const Experiment* commands = findings.find("concurrent", Setting::commands);
    const Experiment* events = findings.find("concurrent", Setting::events);
    add_plot(plots, commands, "experiments.figure.4.34", "Figure 4.34: concurrent, sending a command", "ns",
             &TaskResult::sends);
    add_plot(plots, commands, "experiments.figure.4.35", "Figure 4.35: concurrent, processing commands", "ns",
             &TaskResult::served);
    add_plot(plots, events, "experiments.figure.4.42", "Figure 4.42: concurrent, emitting an event", "ns",
             &TaskResult::sends);
    add_plot(plots, events, "experiments.figure.4.43", "Figure 4.43: concurrent, processing events", "ns",
             &TaskResult::served);
    return plots;
}

} // namespace tappet::experiments
