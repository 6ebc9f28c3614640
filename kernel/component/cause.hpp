// The cause of an execution: the time stamp of the edge or the frame that a driver received. It travels with
// each message and with each value that wakes, from activity to activity, so that every row knows the time
// from the cause to its own end.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>

namespace tappet {

/// No cause, or the machine itself: a period, a timer, an operator.
inline constexpr Time no_cause{};

namespace detail {

inline constinit thread_local Time running_cause = no_cause;

} // namespace detail

/// Returns the cause of what the calling thread does now. Real-time.
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

/// Takes a stamp as the cause of what the calling thread does for the rest of its cycle, if it has none.
/// Real-time.
inline void note_cause(Time stamp) noexcept TAPPET_REALTIME {
    if (running_cause() == no_cause) set_running_cause(stamp);
}

/// Sets the cause of what the calling thread does, until destroyed. Real-time; made by drivers.
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

/// How long a row took: from the stamp of the edge or the frame to the end of the row's work, including the
/// writes of outputs. One thread adds, any thread may read; consistent between two cycles of the receiving
/// activity. The layout is part of the machine's map.
struct ReactionTimes {
    static constexpr std::size_t bins = 16;

    std::uint64_t count = 0;
    Duration total{};
    Duration longest{};
    /// The first bin counts times below 1 us, each further one covers twice the time of the one before it,
    /// the last also counts all from 16 ms on.
    std::array<std::uint32_t, bins> histogram{};

    void add(Duration took) noexcept TAPPET_REALTIME {
        took = std::max(took, Duration::zero()); // the cause arrived after the last stamp
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
