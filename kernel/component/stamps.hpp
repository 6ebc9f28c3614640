// The time at which a value was true, and how far its writer is believed.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"

#include <cstdint>

namespace tappet {

/// Earlier than every time stamp of a machine: the value is as old as can be.
inline constexpr Time before_all{-std::chrono::hours{24 * 365 * 100}};
/// Longest lead of a stamp over the cycle's time: a cycle may be long, and a value that arrives during it has
/// a later time than the cycle.
inline constexpr Duration ahead_at_most = 1s;
/// Longest lead of a value that arrives while a cycle runs, after the begin of that cycle.
inline constexpr Duration arrives_within = 1ms;
/// Returns the stamp of a value that is written in the cycle at `now`. A stamp further ahead than
/// ahead_at_most, or before all, comes from no clock of this machine: the time of such a value is unknown,
/// and before_all is returned.
constexpr Time judged_stamp(Time stamp, Time now) noexcept TAPPET_REALTIME {
    // Both comparisons in one, in four instructions: a stamp too far ahead wraps round to more than any age.
    const auto number = [](auto time) { return static_cast<std::uint64_t>(time.count()); };
    const std::uint64_t age =
        number(now.time_since_epoch()) + number(ahead_at_most) - number(stamp.time_since_epoch());
    return age >> 62u != 0 ? before_all : stamp;
}

} // namespace tappet
