// The state of a frame on demand. With it each demand leaves once, whatever is forced meanwhile.
#pragma once

#include "kernel/base/time.hpp"

#include <cstdint>

namespace tappet::can {

/// What reading the inputs of a frame found.
struct Reading {
    bool usable = true;  ///< each was written; what is stale has a substitute
    bool fresh = false;  ///< one was written since the last reading
    bool agreed = true;  ///< all are of the same time, but what is forced or substituted: that is true now
    bool forced = false; ///< one of them
    Time at = never;     ///< that time; never: all is true now
    std::uint64_t writes = 0; ///< of all of them, also behind forces; of a frame on demand
};

/// Of a frame on demand.
struct Demand {
    Time may_follow{};     ///< the next one, or it comes too often
    Time at = Time::min(); ///< that was handled last
    bool is_open = false;
    bool is_hidden = false;                   ///< behind a force
    std::uint64_t forgotten = 0, handled = 0; ///< writes by then
};

} // namespace tappet::can
