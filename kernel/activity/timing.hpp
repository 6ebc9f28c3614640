// The durations of functions: every function of an activity is timed in every cycle.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"

#include <cstdint>

namespace tappet {

/// Wall time of one function, preemption included. The first pass fills caches and touches memory; it is left
/// out so that it is not the maximum for ever.
struct FunctionTiming {
    std::uint64_t passes = 0;
    Duration last{};
    Duration longest{-1}; ///< negative before the first pass
    Duration total{};
    std::uint64_t blamed = 0; ///< missed deadlines of which this function was the culprit

    /// `together`: number of passes that were timed as one.
    void add(Duration took, std::uint64_t together = 1) noexcept TAPPET_REALTIME {
        const bool is_first = passes == 0;
        passes += is_first ? 1 : together;
        total += took;
        last = together == 1 ? took : took / static_cast<std::int64_t>(together);
        if (last <= longest) return;
        longest = is_first ? Duration::zero() : last;
        if (is_first) total = Duration::zero();
    }
    /// Returns the mean of all passes but the first.
    [[nodiscard]] Duration usual() const noexcept TAPPET_REALTIME {
        return passes > 1 ? total / static_cast<std::int64_t>(passes - 1) : last;
    }
    /// Returns whether took - usual() > excess, without a division.
    [[nodiscard]] bool exceeds_usual(Duration took, Duration excess) const noexcept TAPPET_REALTIME {
        const std::int64_t above = (took - excess).count();
        if (above <= 0) return false;
        if (passes < 2) return above > last.count();
        std::int64_t least = 0;
        return __builtin_mul_overflow(above, static_cast<std::int64_t>(passes - 1), &least) ||
               total.count() < least;
    }
};

/// One missed deadline.
struct Miss {
    static constexpr std::uint32_t nobody = 0xffffffffu;
    std::uint32_t function =
        nobody; ///< index into the engine's functions; nobody: the activity itself began late
    Time release{};
    Duration response{}; ///< from release to the end of the cycle
    Duration took{};     ///< time of the culprit, or the delay of the begin
    Duration usual{};
};

} // namespace tappet
