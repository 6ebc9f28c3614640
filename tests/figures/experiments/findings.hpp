// What all experiments together found out, as figures, plots and statements.
#pragma once

#include "tests/figures/experiments/run.hpp"
#include "tests/figures/measure/result.hpp"

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::experiments {

inline constexpr const char* application_names[] = {"minimal", "small", "concurrent", "large"};

class Findings {
public:
    /// The experiment of that name and setting, made when it is not there yet.
    Experiment& at(std::string_view application, Setting setting);
    /// The highest priority of an application as a bare thread, made when it is not there yet.
    TaskResult& bare(std::string_view application);
    /// Null: it was not run, or has no such task.
    [[nodiscard]] const TaskResult* find_bare(std::string_view application) const;
    [[nodiscard]] const Experiment* find(std::string_view application, Setting setting) const;
    [[nodiscard]] const TaskResult* find(std::string_view application, Setting setting,
                                         std::string_view task) const;
    [[nodiscard]] const std::vector<Experiment>& all() const { return experiments_; }

private:
    std::vector<Experiment> experiments_{};
    std::map<std::string, TaskResult, std::less<>> bare_{};
};

/// Periods, latencies, exchanges, sends and serving: tables of every application.
std::vector<figures::Figure> figures_of(const Findings& findings);
/// The histograms of the thesis: 4.9 and 4.10, 4.14 to 4.23, 4.34 and 4.35, 4.42 and 4.43.
std::vector<figures::Plot> plots_of(const Findings& findings);
/// What the thesis draws from them, true or false as measured. Of experiments that were not run there is
/// none.
std::vector<figures::Statement> statements_of(const Findings& findings);

/// The histograms of all tasks as files that gnuplot reads: one for each real-time task, application and
/// setting, as the thesis kept them (A.2.2). "concurrent-data-high.txt" and so on: a block for each thing
/// that was measured, two empty lines between them, each line the lower end of a bin and how many executions
/// fell into it. Empty: written; else why not.
std::string write_histograms(const Findings& findings, const std::string& directory);

} // namespace tappet::experiments
