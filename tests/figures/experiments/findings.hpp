// The findings of all experiments together, as figures, plots and statements.
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
    /// Returns the experiment of that name and setting; makes it when it does not exist.
    Experiment& at(std::string_view application, Setting setting);
    /// Returns the highest priority of an application as a bare thread; makes it when it does not exist.
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
/// The conclusions of the thesis, true or false as measured. There is none about experiments that were not
/// run.
std::vector<figures::Statement> statements_of(const Findings& findings);

/// The histograms of all tasks as files that gnuplot reads: one for each real-time task, application and
/// setting, as the thesis kept them (A.2.2). "concurrent-data-high.txt" and so on: a block for each
/// measured quantity, two empty lines between them, each line with the lower end of a bin and the number of
/// executions in it. Empty: written; else the reason why not.
std::string write_histograms(const Findings& findings, const std::string& directory);

} // namespace tappet::experiments
