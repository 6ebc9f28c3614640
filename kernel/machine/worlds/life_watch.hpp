// SPDX-License-Identifier: Apache-2.0
// Watches from outside whether the activities of a machine show life; needs read access to the machine's
// memory.
#pragma once

#include "kernel/machine/instance/placed.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace tappet {

/// An activity owes a sign of life while it is in a cycle, was woken, or is past its wake time. It shows life
/// by beginning or ending a cycle. An activity that sleeps and is not due owes none, however long. Activities
/// that are not real-time may block, and are not watched.
class LifeWatch {
public:
    LifeWatch(PlacedMachine& machine, Duration within) noexcept : machine_{machine}, within_{within} {}

    static constexpr std::size_t all_live = ~std::size_t{0};
    /// Returns how long an activity may owe a sign: `within`, or twice its deadline if that is longer.
    [[nodiscard]] Duration limit(std::size_t activity) const noexcept {
        return std::max(within_, 2 * machine_.machine().table.activities[activity].deadline());
    }
    /// Returns the first activity that owed a sign for longer than its limit, or all_live. Call it several
    /// times in `within`: a longer pause counts as a frozen box. It reads an engine's values as single words
    /// and follows no pointers: a damaged engine cannot damage the caller.
    [[nodiscard]] std::size_t look(Time now) noexcept {
        // The caller has the highest priority: while it did not look, nothing ran. A quarter of `within`
        // counts of each pause, so that even a caller that is always late detects a hang.
        const Duration frozen = std::max(now - last_ - within_ / 4, Duration{});
        last_ = now;
        const auto engines = machine_.engines();
        for (std::size_t a = 0; a < engines.size(); ++a) {
            const Engine& engine = engines[a];
            const ActivityRow& row = machine_.machine().table.activities[a];
            Seen& seen = seen_[a];
            const std::uint64_t generation = engine.generation();
            const bool in_cycle = generation % 2 != 0;
            const bool owes = row.real_time && engine.is_active() &&
                              (in_cycle || engine.is_woken() || engine.wakes_at() <= now);
            if (!owes || !seen.owed || generation != seen.generation)
                seen = {generation, owes, now};
            else if (now - (seen.since += frozen) > limit(a))
                return a;
        }
        return all_live;
    }

private:
    struct Seen {
        std::uint64_t generation = 0;
        bool owed = false;
        Time since{};
    };
    PlacedMachine& machine_;
    Duration within_;
    Time last_{};
    std::array<Seen, max_activities> seen_{};
};

} // namespace tappet
