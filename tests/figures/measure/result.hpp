// The result of a program of figures, in the one form that the report and the programs' tests read: JSON, one
// file for each program.
#pragma once

#include "tests/figures/measure/samples.hpp"

#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tappet::figures {

/// Ours, its physical or bare limit, or another product for the same task.
enum class Standing : std::uint8_t { ours, floor, peer };
[[nodiscard]] const char* to_text(Standing role) noexcept;

/// One measured thing.
struct Row {
    std::string name;
    Standing role = Standing::ours;
    Summary summary;                         ///< in the figure's unit
    std::optional<double> instructions = {}; ///< for one operation, counted under callgrind
};

/// Rows that do the same, measured in turns in one run.
struct Figure {
    std::string id; ///< stable: two commits are compared by it; "exchange.local.160"
    std::string title;
    std::string unit = "ns";
    std::string source = {}; ///< thesis section, standard or paper
    std::string how = {};    ///< what one sample is: "mean of 64 operations in a row"
    std::vector<Row> rows = {};
};

/// A goal: `measured` at most `limit`, both in `unit` ("x" for a ratio).
struct Goal {
    std::string text;
    double limit = 0;
    double measured = 0;
    std::string unit = "x";
    std::string detail = {}; ///< the figures that it was calculated from
    [[nodiscard]] bool held() const { return measured <= limit; }
};

/// A claim, found true or false as measured.
struct Statement {
    std::string text;
    bool held = false;
    std::string measured;
};

struct Series {
    std::string name;
    Standing role = Standing::ours;
    std::vector<std::pair<double, double>> points; ///< of a histogram: lower end of the bin, how many
};

struct Plot {
    std::string id;
    std::string title;
    std::string x, y; ///< the meaning of the axes, with units
    bool histogram = false;
    bool log_x = false, log_y = false;
    std::vector<Series> series;
};

struct Result {
    std::string program;
    std::string setting = "short";
    std::vector<Figure> figures = {};
    std::vector<Goal> goals = {};
    std::vector<Statement> statements = {};
    std::vector<Plot> plots = {};
    std::vector<std::string> notes = {}; ///< measurements that were not possible here, and why

    /// Null: there is no such row.
    [[nodiscard]] const Row* find(std::string_view figure, std::string_view row) const;
    /// As JSON.
    [[nodiscard]] std::string text() const;
    /// Empty: written. Otherwise the reason why not.
    [[nodiscard]] std::string write(const std::string& path) const;
    /// As tables, with the ratio of each row to the first of ours.
    void print() const;
};

/// Reads a result. Otherwise one sentence: the file is missing, empty or broken. JSON's null becomes NaN: a
/// goal with one is missed.
std::expected<Result, std::string> read_result(const std::string& path);

/// Samples as a histogram of `bins` bins of equal width between the smallest and the quantile `upto`; the
/// last bin holds the rest.
Series histogram(std::string name, Standing role, const Samples& samples, std::size_t bins = 100,
                 double upto = 1);

/// As above, of positive samples, over all of them: `in_a_decade` bins make a factor of ten, so that both a
/// peak and a distant worst case are visible. For a plot with log_x.
Series log_histogram(std::string name, Standing role, const Samples& samples, int in_a_decade = 40);

/// The number of samples in each bin, drawn so that one is visible beside many; with `log_x` for
/// log_histogram.
Plot histogram_plot(std::string id, std::string title, std::string x, std::string y,
                    std::vector<Series> series, bool log_x = false);

} // namespace tappet::figures
