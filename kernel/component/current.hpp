// The activity that the calling thread runs. An event that several activities emit uses it to find the
// emitter's share of its rows. In virtual time one thread runs every engine, so it changes with the engine.
#pragma once

#include "kernel/base/contract.hpp"
#include "kernel/base/time.hpp"

#include <cstdint>

namespace tappet {

/// The number of a thread that runs no activity.
inline constexpr std::uint32_t no_activity = 0xffffffffu;

namespace detail {

inline constinit thread_local std::uint32_t running_activity = no_activity;
/// The activity's time of the cycle, by which ports recognise their own activity; null: not stated.
inline constinit thread_local const Time* running_clock = nullptr;

} // namespace detail

/// Returns the number, in the order of the table, of the activity that the calling thread runs. Real-time.
inline std::uint32_t running_activity() noexcept TAPPET_REALTIME {
    std::uint32_t found = no_activity;
    TAPPET_ESCAPE("thread-local memory of the main program is there from the thread's start",
                  found = detail::running_activity);
    return found;
}

/// Returns whether the calling thread runs the activity of this clock, or no activity: a test, a start-up.
/// Real-time.
inline bool runs_by(const Time* clock) noexcept TAPPET_REALTIME {
    const Time* found = nullptr;
    TAPPET_ESCAPE("thread-local memory of the main program is there from the thread's start",
                  found = detail::running_clock);
    return found == nullptr || found == clock;
}

/// Marks the calling thread as running this activity, until destroyed. `clock`: the activity's time of the
/// cycle. Real-time.
class RunsActivity {
public:
    explicit RunsActivity(std::uint32_t activity, const Time* clock = nullptr) noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("thread-local memory of the main program is there from the thread's start",
                      before_ = detail::running_activity;
                      clock_before_ = detail::running_clock; detail::running_activity = activity;
                      detail::running_clock = clock);
    }
    ~RunsActivity() TAPPET_REALTIME {
        TAPPET_ESCAPE("thread-local memory of the main program is there from the thread's start",
                      detail::running_activity = before_;
                      detail::running_clock = clock_before_);
    }
    RunsActivity(const RunsActivity&) = delete;
    RunsActivity& operator=(const RunsActivity&) = delete;

private:
    std::uint32_t before_ = no_activity;
    const Time* clock_before_ = nullptr;
};

} // namespace tappet
