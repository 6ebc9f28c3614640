// The bootstrap: pairs are drawn with replacement, which gives each sample a weight; a quantile is a walk
// over sorted samples until the weights after it suffice.
#include "tests/figures/measure/equivalence.hpp"

#include "kernel/base/random.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace tappet::figures {

namespace {

struct Weighed {
    double value;
    std::uint32_t block;
};

std::vector<Weighed> sorted(const std::vector<PairOfBlocks>& pairs,
                            std::vector<double> PairOfBlocks::* side) {
    std::vector<Weighed> all;
    for (std::size_t block = 0; block < pairs.size(); ++block)
        for (const double value : pairs[block].*side)
            all.push_back({value, static_cast<std::uint32_t>(block)});
    std::sort(all.begin(), all.end(), [](const Weighed& a, const Weighed& b) { return a.value < b.value; });
    return all;
}

double quantile(const std::vector<Weighed>& samples, const std::vector<std::uint32_t>& weights, double q) {
    std::uint64_t total = 0;
    for (const Weighed& each : samples) total += weights[each.block];
    if (total == 0) return 0;
    const auto wanted = static_cast<std::uint64_t>(q * static_cast<double>(total - 1) + 0.5);
    std::uint64_t seen = 0;
    for (const Weighed& each : samples) {
        seen += weights[each.block];
        if (seen > wanted) return each.value;
    }
    return samples.back().value;
}

} // namespace

Samples all_of(const std::vector<PairOfBlocks>& pairs, std::vector<double> PairOfBlocks::* side) {
    Samples samples;
    for (const PairOfBlocks& pair : pairs)
        for (const double value : pair.*side) samples.add(value);
    return samples;
}

double Comparison::worst() const noexcept { return low > 0 ? std::max(high, 1 / low) : 0; }

Verdict Comparison::verdict() const noexcept {
    if (low <= 0) return Verdict::undecided;
    const double most = 1 + margin;
    if (low >= 1 / most && high <= most) return Verdict::equivalent;
    if (high < 1 / most || low > most) return Verdict::different;
    return Verdict::undecided;
}

std::string Comparison::text() const {
    constexpr std::array verdicts{"equivalent", "different", "undecided"};
    std::array<char, 160> text{};
    std::snprintf(text.data(), text.size(), "ratio %.3f, 90 %% interval %.3f to %.3f from %zu pairs: %s",
                  ratio, low, high, pairs, verdicts[static_cast<std::size_t>(verdict())]);
    return text.data();
}

Comparison compare(const std::vector<PairOfBlocks>& pairs, double q, double margin, std::size_t resamples,
                   std::uint64_t seed) {
    Comparison result{.margin = margin, .pairs = pairs.size()};
    const std::vector<Weighed> ours = sorted(pairs, &PairOfBlocks::ours);
    const std::vector<Weighed> theirs = sorted(pairs, &PairOfBlocks::theirs);
    std::vector<std::uint32_t> weights(pairs.size(), 1);
    const double of = quantile(theirs, weights, q);
    if (ours.empty() || of <= 0) return result;
    result.ratio = quantile(ours, weights, q) / of;
    if (pairs.size() < fewest_pairs) return result;

    Random random{seed};
    std::vector<double> ratios;
    for (std::size_t n = 0; n < resamples; ++n) {
        std::fill(weights.begin(), weights.end(), 0);
        for (std::size_t draw = 0; draw < pairs.size(); ++draw) ++weights[random.below(pairs.size())];
        const double below = quantile(theirs, weights, q);
        if (below > 0) ratios.push_back(quantile(ours, weights, q) / below);
    }
    if (ratios.empty()) return result;
    std::sort(ratios.begin(), ratios.end());
    const auto at = [&](double share) {
        return ratios[static_cast<std::size_t>(share * static_cast<double>(ratios.size() - 1) + 0.5)];
    };
    result.low = at(0.05);
    result.high = at(0.95);
    return result;
}

} // namespace tappet::figures
