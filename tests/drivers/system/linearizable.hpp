// Whether the observations of several callers of one object can result from calls in sequence: the search of
// Wing and Gong (1993), with Lowe's memo (2017) of tried states.
#pragma once

#include "kernel/base/time.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <utility>

namespace tappet::history {

/// A call, as seen by its caller.
struct Operation {
    Time invoked{};
    Time responded = never;
    std::int32_t argument = 0;
    /// Empty: it is unknown whether the call happened; if so, at any time after its invocation.
    std::optional<std::int32_t> result{};
};

/// The object without its callers: changes the state, which begins at 0, and returns the answer.
using Apply = std::int32_t (*)(std::int32_t& state, std::int32_t argument);

/// Checks one object. By locality (Herlihy and Wing 1990), a history of several objects is right when that of
/// each one is.
class Linearization {
public:
    static constexpr std::size_t most = 64; ///< the memo keeps a bit for each
    Linearization(std::span<const Operation> operations, Apply apply)
        : operations_{operations}, apply_{apply} {}

    /// Also false for more than `most` calls: the search must be complete.
    [[nodiscard]] bool exists() { return operations_.size() <= most && goes_on(0, 0); }

private:
    static constexpr std::uint64_t bit(std::size_t i) { return std::uint64_t{1} << i; }

    /// Searches on from here, after the calls in `past`.
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
        // First those that must have happened: mostly they did.
        for (const bool is_known : {true, false})
            for (std::size_t i = 0; i < operations_.size(); ++i) {
                const Operation& each = operations_[i];
                // A call that began after the end of another one comes after it.
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
