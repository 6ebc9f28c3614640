// Decides whether two things take the same time within a stated margin. It proves that a larger difference
// would have been seen; too few samples prove nothing.
#pragma once

#include "tests/figures/measure/samples.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tappet::figures {

/// Samples of both, taken side by side in time: each disturbance affected both. Samples of one pair may
/// depend on each other; pairs are taken to be independent.
struct PairOfBlocks {
    std::vector<double> ours{};
    std::vector<double> theirs{};
};
[[nodiscard]] Samples all_of(const std::vector<PairOfBlocks>& pairs,
                             std::vector<double> PairOfBlocks::* side);

enum class Verdict : std::uint8_t {
    equivalent, ///< the interval lies within the margin
    different,  ///< it lies outside of it
    undecided   ///< it reaches over an edge: there were too few samples, or they scatter too much
};

/// Ours divided by theirs. Fewer pairs give no verdict: they all lie on one side of the truth more often than
/// the interval's error on that side allows.
inline constexpr std::size_t fewest_pairs = 5;
static_assert(1.0 / (1 << fewest_pairs) < 0.05);

struct Comparison {
    double ratio = 0;
    double low = 0, high = 0; ///< two-sided 90 % interval: each side is left with 5 %
    double margin = 0;
    std::size_t pairs = 0;

    /// The largest plausible distance of the ratio from 1, as a factor of at least 1: the interval's further
    /// edge.
    [[nodiscard]] double worst() const noexcept;
    [[nodiscard]] Verdict verdict() const noexcept;
    /// "ratio 1.012, 90 % interval 0.998 to 1.031 from 220 pairs: equivalent"
    [[nodiscard]] std::string text() const;
};

/// Compares the quantile `q` of all of ours with that of all of theirs. Two one-sided tests (Schuirmann,
/// 1987) at 5 % by the percentile bootstrap (Efron, 1979) over pairs. `margin`: 0.05 allows ratios from 1
/// / 1.05 to 1.05. Same seed, same result. Without samples, or when theirs is 0: a ratio of 0, undecided.
[[nodiscard]] Comparison compare(const std::vector<PairOfBlocks>& pairs, double q, double margin,
                                 std::size_t resamples = 1000, std::uint64_t seed = 1);

} // namespace tappet::figures
