// Which activity the calling thread runs. An event that several activities emit finds each one's share of its
// rows by it; in virtual time, where one thread runs every engine, it changes with the engine.
#pragma once

#include "kernel/base/realtime.hpp"

#include <cstdint>

namespace tappet {

/// Of a thread that runs no activity.
inline constexpr std::uint32_t no_activity = 0xffffffffu;

namespace detail {

inline constinit thread_local std::uint32_t running_activity = no_activity;

} // namespace detail

/// The number, in the order of the table, of the activity that the calling thread runs. Real-time.
inline std::uint32_t running_activity() noexcept TAPPET_REALTIME {
    std::uint32_t found = no_activity;
    TAPPET_ESCAPE("thread-local memory of the main program is there from the thread's start",
                  found = detail::running_activity);
    return found;
}

/// While it lives, the calling thread runs this activity. Real-time.
class RunsActivity {
public:
    explicit RunsActivity(std::uint32_t activity) noexcept TAPPET_REALTIME : before_{running_activity()} {
        if (before_ != activity) set(activity);
    }
    ~RunsActivity() TAPPET_REALTIME {
        if (running_activity() != before_) set(before_);
    }
    RunsActivity(const RunsActivity&) = delete;
    RunsActivity& operator=(const RunsActivity&) = delete;

private:
    static void set(std::uint32_t activity) noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("thread-local memory of the main program is there from the thread's start",
                      detail::running_activity = activity);
    }
    std::uint32_t before_;
};

} // namespace tappet
