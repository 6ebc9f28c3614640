// Whether what several callers saw of one object could have come of one call after the other: the search of
// Wing and Gong (1993), with Lowe's memo (2017) of what was tried.
#pragma once

#include "kernel/base/time.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <utility>

namespace tappet::history {

/// A call, as its caller saw it.
struct Operation {
    Time invoked{};
    Time responded = never;
    std::int32_t argument = 0;
    /// None: nobody knows whether it happened; if it did, then at any time after its invocation.
    std::optional<std::int32_t> result{};
};

/// The object without its callers: changes the state, which begins at 0, and answers.
using Apply = std::int32_t (*)(std::int32_t& state, std::int32_t argument);

/// Of one object. By locality (Herlihy and Wing 1990) a history of several is right when that of each one is.
class Linearization {
public:
    static constexpr std::size_t most = 64; ///< the memo keeps a bit for each
    Linearization(std::span<const Operation> operations, Apply apply)
        : operations_{operations}, apply_{apply} {}

    /// False, too, when there are more than `most`: what is not searched is not found right.
    [[nodiscard]] bool exists() { return operations_.size() <= most && goes_on(0, 0); }

private:
    static constexpr std::uint64_t bit(std::size_t i) { return std::uint64_t{1} << i; }

    /// From here on, with those of `past` behind it.
    bool goes_on(std::uint64_t past, std::int32_t state) {
        Time first_response = never;
        bool is_over = true;
        for (std::size_t i = 0; i < operations_.size(); ++i) {
            if ((past & bit(i)) != 0 || !operations_[i].result) continue;
            is_over = false;
            first_response = std::min(first_response, operations_[i].responded);
        }
        if (is_over) return true;
        if (!tried_.insert({past, state}).second) return false;
        // Those that must have happened first: mostly they did.
        for (const bool is_known : {true, false})
            for (std::size_t i = 0; i < operations_.size(); ++i) {
                const Operation& each = operations_[i];
                // Whatever began after another one's end comes behind it.
                if ((past & bit(i)) != 0 || each.result.has_value() != is_known ||
                    each.invoked > first_response)
                    continue;
                std::int32_t then = state;
                const std::int32_t result = apply_(then, each.argument);
                if ((!is_known || result == *each.result) && goes_on(past | bit(i), then)) return true;
            }
        return false;
    }

    std::span<const Operation> operations_;
    Apply apply_;
    std::set<std::pair<std::uint64_t, std::int32_t>> tried_{};
};

} // namespace tappet::history
