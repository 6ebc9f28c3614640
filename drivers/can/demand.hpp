// The state of a frame on demand: each demand is sent once, regardless of forces.
#pragma once

#include "kernel/base/time.hpp"

#include <cstdint>

namespace tappet::can {

/// The result of reading a frame's inputs.
struct Reading {
    bool usable = true;  ///< each was written; a stale one has a substitute
    bool fresh = false;  ///< at least one was written since the last reading
    bool agreed = true;  ///< all have the same time, except forced or substituted ones, which are current
    bool forced = false; ///< at least one is forced
    bool held = false;   ///< at least one has its safe value, because its gate is closed
    Time at = never;     ///< that time; never: all are current
    std::uint64_t writes = 0; ///< number of writes to all of them, also behind forces; for a frame on demand
};

/// The state of a frame on demand.
struct Demand {
    Time may_follow{};     ///< earliest time of the next one; a sooner one is too often
    Time at = Time::min(); ///< time of the last one handled
    bool is_open = false;
    bool is_hidden = false;                   ///< behind a force
    std::uint64_t forgotten = 0, handled = 0; ///< number of writes at that time
};

} // namespace tappet::can
