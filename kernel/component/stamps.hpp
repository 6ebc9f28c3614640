// When a value was true, as far as its writer is believed.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"

#include <cstdint>

namespace tappet {

/// Earlier than every time stamp of a machine: the value is as old as can be.
inline constexpr Time before_all{-std::chrono::hours{24 * 365 * 100}};
/// A cycle may be long, and what arrives during it has a later time than the cycle's.
inline constexpr Duration ahead_at_most = 1s;
/// A value may arrive while a cycle runs: then its time lies so much after the begin of the cycle at most.
inline constexpr Duration arrives_within = 1ms;
/// The time of a value that is written in the cycle at `now`. A time further ahead than ahead_at_most, or
/// before all, comes from no clock of this machine: nobody knows when such a value was true.
constexpr Time judged_stamp(Time stamp, Time now) noexcept TAPPET_REALTIME {
    // Both at once, in four instructions: what is ahead wraps round to more than an age can be.
    const auto number = [](auto time) { return static_cast<std::uint64_t>(time.count()); };
    const std::uint64_t age =
        number(now.time_since_epoch()) + number(ahead_at_most) - number(stamp.time_since_epoch());
    return age >> 62u != 0 ? before_all : stamp;
}

} // namespace tappet
