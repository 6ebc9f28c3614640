// What set something off: the time stamp of the edge or the frame that a driver took in. It goes along with
// each message and with each value that wakes, from activity to activity, so that every row knows how long
// what it leads to took from there.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>

namespace tappet {

/// Nothing did, or the machine itself: a period, a timer, an operator.
inline constexpr Time no_cause{};

namespace detail {

inline constinit thread_local Time running_cause = no_cause;

} // namespace detail

/// Of what the calling thread does now. Real-time.
inline Time running_cause() noexcept TAPPET_REALTIME {
    Time found = no_cause;
    TAPPET_ESCAPE("thread-local memory of the main program is there from the thread's start",
                  found = detail::running_cause);
    return found;
}
inline void set_running_cause(Time stamp) noexcept TAPPET_REALTIME {
    TAPPET_ESCAPE("thread-local memory of the main program is there from the thread's start",
                  detail::running_cause = stamp);
}

/// While it lives, what the calling thread does was set off at `stamp`. Real-time; made by drivers.
class CausedBy {
public:
    explicit CausedBy(Time stamp) noexcept TAPPET_REALTIME : before_{running_cause()} {
        set_running_cause(stamp);
    }
    ~CausedBy() TAPPET_REALTIME { set_running_cause(before_); }
    CausedBy(const CausedBy&) = delete;
    CausedBy& operator=(const CausedBy&) = delete;

private:
    Time before_;
};

/// How long a row took: from the edge's or the frame's stamp to the end of what the row had to have done,
/// outputs written included. One thread adds, any may read; whole between two cycles of the receiving
/// activity. The layout is part of the machine's map.
struct ReactionTimes {
    static constexpr std::size_t bins = 16;

    std::uint64_t count = 0;
    Duration total{};
    Duration longest{};
    /// The first counts those below 1 us, each further one twice the time of the one before it, the last also
    /// all from 16 ms on.
    std::array<std::uint32_t, bins> histogram{};

    void add(Duration took) noexcept TAPPET_REALTIME {
        took = std::max(took, Duration::zero()); // what set it off arrived after the last stamp
        const auto us = static_cast<std::uint64_t>(took.count() / 1000);
        ++histogram[std::min<std::size_t>(static_cast<std::size_t>(std::bit_width(us)), bins - 1)];
        ++count;
        total += took;
        longest = std::max(longest, took);
    }
    [[nodiscard]] Duration mean() const noexcept TAPPET_REALTIME {
        return count == 0 ? Duration::zero() : total / static_cast<std::int64_t>(count);
    }
};
static_assert(sizeof(ReactionTimes) == 88, "the layout is part of the machine's map");

/// A connection row that wakes its reader.
struct WakingRow {
    std::atomic<std::int64_t> cause_ns{0}; ///< of the value written last
    ReactionTimes times{};                 ///< the reader's

    [[nodiscard]] Time cause() const noexcept TAPPET_REALTIME {
        return at_ns(cause_ns.load(std::memory_order_relaxed)); // no step: for the report
    }
};

} // namespace tappet
