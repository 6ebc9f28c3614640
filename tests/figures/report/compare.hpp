// Two commits beside each other: both were run in turns, and each row is judged by the ratios of all rounds.
#pragma once

#include "tests/figures/measure/result.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tappet::figures {

/// The results of all programs of both commits in one round, run right after one another.
struct Round {
    std::vector<Result> before;
    std::vector<Result> after;
};

enum class Verdict : std::uint8_t { same, slower, faster };

struct Change {
    std::string figure; ///< id
    std::string row;
    Standing role = Standing::ours;
    double ratio = 1;         ///< after / before, the geometric mean over the rounds
    double low = 1, high = 1; ///< 99 % confidence interval of it
    std::size_t rounds = 0;
    std::optional<double> instructions_before = {}, instructions_after = {};
    Verdict verdict = Verdict::same;
};

struct Comparison {
    std::vector<Change> changes;       ///< rows that both commits have
    std::vector<std::string> only_one; ///< "only before: exchange.local.160, ours"
    double noise = 0; ///< the 95 % quantile of the changes of floors and peers, although their code is the
                      ///< same in both
    double margin = 0;
    /// The smallest ratio that counts as a change: 0.05 is 5 %.
    [[nodiscard]] double threshold() const { return noise > margin ? noise : margin; }
    [[nodiscard]] bool slower() const;
};

/// Ours is slower when the interval lies above 1 and the ratio above 1 + threshold(); faster is defined the
/// same way.
Comparison compare(const std::vector<Round>& rounds, double margin);

/// The mean of logarithms with its 99 % interval by Student's t, as factors: {mean, low, high}. A single
/// value has an interval from 0 to infinity.
struct Interval {
    double mean, low, high;
};
Interval mean_of_ratios(const std::vector<double>& ratios);

/// As text: the slower and the faster rows, and the number of unchanged ones.
std::string comparison_text(const Comparison& comparison, const std::string& before,
                            const std::string& after);

} // namespace tappet::figures
