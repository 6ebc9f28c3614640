// Times of a power cut: random instants in stretches of a log; each stretch has its own allowed results.
#pragma once

#include "tests/bench/image/judge.hpp"
#include "tests/bench/image/power_cut.hpp"

#include <algorithm>
#include <random>
#include <vector>

namespace tappet::bench {

/// The writes from one mark to the next.
struct Stretch {
    std::size_t begin = 0, end = 0; ///< entries
    Allowed allowed{};
};

struct Instant {
    std::size_t entry = 0; ///< the power fails before this entry is written
    Allowed allowed{};
};

/// Instants in order. Half of them lie before a flush, when most writes are pending.
inline std::vector<Instant> draw(const WriteLog& log, const std::vector<Stretch>& stretches,
                                 std::size_t count, std::mt19937_64& lot) {
    std::vector<Instant> all, before_flush, drawn;
    for (const Stretch& each : stretches)
        for (std::size_t i = each.begin; i <= each.end; ++i) {
            all.push_back({i, each.allowed});
            if (i < log.entries().size() && log.entries()[i].is_flush) before_flush.push_back(all.back());
        }
    for (std::size_t i = 0; i < count; ++i) {
        const auto& from = i % 2 == 0 || before_flush.empty() ? all : before_flush;
        drawn.push_back(from[lot() % from.size()]);
    }
    std::ranges::stable_sort(drawn, {}, &Instant::entry);
    return drawn;
}

} // namespace tappet::bench
