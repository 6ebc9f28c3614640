// Paired ratios, so that a disturbance in a round affects both commits.
#include "tests/figures/report/compare.hpp"

#include "tests/figures/report/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace tappet::figures {

namespace {

/// Student's t, two-sided 99 %, of 1 to 20 degrees of freedom; more degrees use the last value, which is
/// larger than theirs.
constexpr std::array student{63.657, 9.925, 5.841, 4.604, 4.032, 3.707, 3.499, 3.355, 3.250, 3.169,
                             3.106,  3.055, 3.012, 2.977, 2.947, 2.921, 2.898, 2.878, 2.861, 2.845};

struct Pairs {
    Standing role = Standing::ours;
    std::size_t before = 0, after = 0; ///< rounds that contain it
    std::vector<double> ratios = {};
    std::optional<double> instructions_before = {}, instructions_after = {};
};
using Key = std::pair<std::string, std::string>; ///< figure's id, row

std::map<Key, const Row*> rows_of(const std::vector<Result>& results) {
    std::map<Key, const Row*> rows;
    for (const Result& result : results)
        for (const Figure& figure : result.figures)
            for (const Row& row : figure.rows) rows[{figure.id, row.name}] = &row;
    return rows;
}

} // namespace

Interval mean_of_ratios(const std::vector<double>& ratios) {
    const auto n = static_cast<double>(ratios.size());
    double sum = 0, squares = 0;
    for (const double ratio : ratios) sum += std::log(ratio);
    const double mean = sum / n;
    for (const double ratio : ratios) squares += (std::log(ratio) - mean) * (std::log(ratio) - mean);
    if (ratios.size() < 2) return {std::exp(mean), 0, std::numeric_limits<double>::infinity()};
    const double t = student[std::min(ratios.size() - 2, student.size() - 1)];
    const double half = t * std::sqrt(squares / (n - 1) / n);
    return {std::exp(mean), std::exp(mean - half), std::exp(mean + half)};
}

bool Comparison::slower() const {
    return std::ranges::any_of(changes,
                               [](const Change& change) { return change.verdict == Verdict::slower; });
}

Comparison compare(const std::vector<Round>& rounds, double margin) {
    std::map<Key, Pairs> all;
    for (const Round& round : rounds) {
        const auto before = rows_of(round.before), after = rows_of(round.after);
        for (const auto& [key, row] : before) {
            Pairs& pairs = all[key];
            ++pairs.before;
            pairs.role = row->role;
            if (row->instructions) pairs.instructions_before = row->instructions;
            const auto found = after.find(key);
            if (found == after.end()) continue;
            const double ratio = found->second->summary.median / row->summary.median;
            if (std::isfinite(ratio) && ratio > 0) pairs.ratios.push_back(ratio);
        }
        for (const auto& [key, row] : after) {
            Pairs& pairs = all[key];
            ++pairs.after;
            pairs.role = row->role;
            if (row->instructions) pairs.instructions_after = row->instructions;
        }
    }
    Comparison comparison;
    comparison.margin = margin;
    Samples controls;
    for (const auto& [key, pairs] : all) {
        if (pairs.before == 0 || pairs.after == 0)
            comparison.only_one.push_back(std::string{pairs.after == 0 ? "only before: " : "only after: "} +
                                          key.first + ", " + key.second);
        if (pairs.ratios.empty()) continue;
        const Interval interval = mean_of_ratios(pairs.ratios);
        comparison.changes.push_back({key.first, key.second, pairs.role, interval.mean, interval.low,
                                      interval.high, pairs.ratios.size(), pairs.instructions_before,
                                      pairs.instructions_after});
        if (pairs.role != Standing::ours) controls.add(std::exp(std::abs(std::log(interval.mean))) - 1);
    }
    constexpr std::size_t enough_controls = 5;
    if (controls.count() >= enough_controls) comparison.noise = controls.quantile(0.95);
    const double bound = 1 + comparison.threshold();
    for (Change& change : comparison.changes) {
        if (change.role != Standing::ours) continue;
        if (change.low > 1 && change.ratio > bound) change.verdict = Verdict::slower;
        if (change.high < 1 && change.ratio < 1 / bound) change.verdict = Verdict::faster;
    }
    std::ranges::sort(comparison.changes, std::ranges::greater{}, &Change::ratio);
    return comparison;
}

std::string comparison_text(const Comparison& comparison, const std::string& before,
                            const std::string& after) {
    std::string text = "before: " + before + "\nafter:  " + after + "\n";
    const auto list = [&](Verdict verdict, const std::string& title) {
        std::size_t count = 0;
        for (const Change& change : comparison.changes) {
            if (change.verdict != verdict) continue;
            if (count++ == 0) text += "\n" + title + "\n";
            text += "  " + number_text(change.ratio) + " x (" + number_text(change.low) + " to " +
                    number_text(change.high) + ")  " + change.figure + ": " + change.row;
            if (change.instructions_before && change.instructions_after)
                text += "; instructions " + number_text(*change.instructions_before) + " -> " +
                        number_text(*change.instructions_after);
            text += "\n";
        }
        return count;
    };
    const std::size_t slower = list(Verdict::slower, "slower (after / before, 99 % interval)");
    const std::size_t faster = list(Verdict::faster, "faster");
    std::size_t ours = 0, rounds = 0;
    for (const Change& change : comparison.changes) {
        ours += change.role == Standing::ours ? 1u : 0u;
        rounds = std::max(rounds, change.rounds);
    }
    std::string counted;
    constexpr double least = 0.005; // of the instructions; smaller changes are the loop's own
    for (const Change& change : comparison.changes) {
        if (change.verdict != Verdict::same || change.role != Standing::ours) continue;
        if (!change.instructions_before || !change.instructions_after) continue;
        const double before_it = *change.instructions_before, after_it = *change.instructions_after;
        if (std::abs(after_it - before_it) > least * before_it)
            counted += "  " + number_text(before_it) + " -> " + number_text(after_it) + "  " + change.figure +
                       ": " + change.row + "\n";
    }
    if (!counted.empty()) text += "\nother instructions, no other time\n" + counted;
    std::string restless;
    for (const Change& change : comparison.changes)
        if (change.role != Standing::ours && std::abs(std::log(change.ratio)) > std::log1p(comparison.margin))
            restless += "  " + number_text(change.ratio) + " x  " + change.figure + ": " + change.row + "\n";
    if (!restless.empty()) text += "\nfloors and peers that differ, the same code in both\n" + restless;
    for (const std::string& row : comparison.only_one) text += row + "\n";
    text +=
        "\n" + std::to_string(slower) + " slower, " + std::to_string(faster) + " faster, " +
        std::to_string(ours - slower - faster) + " the same, in " + std::to_string(rounds) +
        " rounds; less than " + number_text(comparison.threshold() * 100) + " % is no change (" +
        (comparison.noise > comparison.margin ? "floors and peers, the same code in both, differed by that"
                                              : "the margin") +
        ")\n";
    return text;
}

} // namespace tappet::figures
