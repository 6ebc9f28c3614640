// The machine's time: nanoseconds since the world began, real (CLOCK_MONOTONIC) or virtual. Never wall-clock
// time.
#pragma once

#include <chrono>
#include <cstdint>

namespace tappet {

using Duration = std::chrono::nanoseconds;

/// The clock of a machine. It has no now(): reading the time is a service of kernel/os, real or virtual.
struct MachineClock {
    using duration = Duration;
    using rep = duration::rep;
    using period = duration::period;
    using time_point = std::chrono::time_point<MachineClock, Duration>;
    static constexpr bool is_steady = true;
};

using Time = MachineClock::time_point;

/// The time no event reaches: an activity that waits for it waits for work only.
inline constexpr Time never = Time::max();

constexpr Time at_ns(std::int64_t ns) noexcept { return Time{Duration{ns}}; }
constexpr std::int64_t to_ns(Time t) noexcept { return t.time_since_epoch().count(); }
constexpr double to_seconds(Duration d) noexcept { return static_cast<double>(d.count()) * 1e-9; }

using namespace std::chrono_literals;

} // namespace tappet
