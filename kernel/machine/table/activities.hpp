// Activity rows: the threads of the machine, their triggers, and their time and memory limits.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/base/row_option.hpp"
#include "kernel/base/time.hpp"

#include <cstdint>
#include <optional>
#include <string_view>

namespace tappet {

// A receiver marks each sending activity, and the requests of components that see the machine, in one 64-bit
// word.
inline constexpr std::size_t max_activities = 63;

enum class Trigger : std::uint8_t { every, on_work, on_device, background };
enum class WhenLate : std::uint8_t { count, stop };

struct ActivityRow {
    static constexpr std::size_t max_runs = 64;
    std::string_view name{};
    Trigger trigger = Trigger::background;
    Duration period{};          ///< every: the period; background: how often it polls
    Duration phase{};           ///< every: delay of each period after its grid point
    std::string_view device{};  ///< on_device: the component whose device wakes it
    std::int64_t at_most_n = 1; ///< sporadic activities: at most n wakes ...
    Duration at_most_per{};     ///< ... in any window of this length
    Duration deadline_after{};  ///< zero: the period
    Duration budget_each{};     ///< processor time of one cycle, synchronous reactions included
    bool real_time = true;
    WhenLate when_late = WhenLate::count;
    std::optional<std::size_t> stack{}; ///< see stack_bytes()
    Bounded<std::string_view, max_runs> runs{};
    bool too_many_runs = false;
    bool has_trigger = false;
    std::string_view twice{}; ///< the option that the row states twice; empty: none

    [[nodiscard]] constexpr Duration shortest_period() const noexcept {
        return trigger == Trigger::every ? period : at_most_per;
    }
    [[nodiscard]] constexpr Duration deadline() const noexcept {
        return deadline_after.count() != 0 ? deadline_after : shortest_period();
    }
    /// Returns the stack size. Real-time functions need less: they call no library that needs much stack.
    [[nodiscard]] constexpr std::size_t stack_bytes() const noexcept {
        return stack.value_or(real_time ? 32 * 1024 : 64 * 1024);
    }
    [[nodiscard]] constexpr bool periodic() const noexcept {
        return trigger == Trigger::every || trigger == Trigger::background;
    }
};

struct TriggerOption {
    Trigger trigger;
    Duration period;
    std::string_view device{};
    Duration phase{};
};
struct Phase {
    Duration after;
};
/// Delays every period by `after` against activities without a phase, so that it runs after the activities
/// whose values it reads.
constexpr Phase phase(Duration after) noexcept { return {after}; }
/// Periodic. Needs a budget unless it is not_real_time; the deadline is the period unless stated. The periods
/// of all activities begin on one grid, no matter when each activity started: periods of 1 ms and 3 ms
/// coincide every 3 ms.
constexpr TriggerOption every(Duration period, Phase phase = {}) noexcept {
    return {Trigger::every, period, {}, phase.after};
}
/// Sporadic: runs when a message, a connection that wakes, or a timer of its components requests it. Needs
/// at_most.
constexpr TriggerOption on_work() noexcept { return {Trigger::on_work, {}, {}}; }
/// Sporadic: runs when the device of this component is ready. Needs at_most.
constexpr TriggerOption on_device(std::string_view component) noexcept {
    return {Trigger::on_device, {}, component};
}

struct AtMost {
    std::int64_t n;
    Duration per;
};
/// At most n wakes in any window of this length. The schedulability analysis relies on it.
constexpr AtMost at_most(std::int64_t n, Duration per) noexcept { return {n, per}; }

struct Budget {
    Duration each;
};
/// Processor time of one cycle, synchronous reactions included. The schedulability analysis relies on it.
constexpr Budget budget(Duration each) noexcept { return {each}; }
/// Time from the release to the end of the cycle. Default: the period, or the window of at_most. A shorter
/// deadline gives a higher priority.
constexpr RowOptionOnce<ActivityRow, Duration> deadline(Duration after) noexcept {
    return {&ActivityRow::deadline_after, after, "deadline"};
}
struct NotRealTime {};
/// May block; runs below every real-time activity, without budget or deadline.
inline constexpr NotRealTime not_real_time{};
/// Stack size of its thread, at least 16 KiB. Default: 32 KiB, or 64 KiB when the activity is not_real_time.
/// The lowest page is a guard: a thread that runs into it stops the machine.
constexpr RowOption<ActivityRow, std::optional<std::size_t>> stack(std::size_t bytes) noexcept {
    return {&ActivityRow::stack, bytes};
}
/// A missed deadline stops the machine. By default a miss is counted and reported.
inline constexpr RowOption stop_when_late{&ActivityRow::when_late, WhenLate::stop};

struct Runs {
    Bounded<std::string_view, ActivityRow::max_runs> names{};
    bool too_many = false;
};
/// The components that the activity runs, 64 at most. The data flow determines their order.
template <class... Names>
constexpr Runs runs(const Names&... names) {
    Runs row;
    ((row.too_many |= !row.names.push(std::string_view{names})), ...);
    return row;
}

namespace detail {

constexpr void apply(ActivityRow& row, const TriggerOption& option) noexcept {
    give(row, "trigger", row.has_trigger);
    row.trigger = option.trigger == Trigger::every && !row.real_time ? Trigger::background : option.trigger;
    row.period = option.period;
    row.phase = option.phase;
    row.device = option.device;
    row.has_trigger = true;
}
constexpr void apply(ActivityRow& row, AtMost option) noexcept {
    give(row, "at_most(...)", row.at_most_per != Duration::zero());
    row.at_most_n = option.n;
    row.at_most_per = option.per;
}
constexpr void apply(ActivityRow& row, Budget option) noexcept {
    give(row, "budget", row.budget_each != Duration::zero());
    row.budget_each = option.each;
}
constexpr void apply(ActivityRow& row, NotRealTime) noexcept {
    row.real_time = false;
    if (row.trigger == Trigger::every) row.trigger = Trigger::background;
}
constexpr void apply(ActivityRow& row, const Runs& option) noexcept {
    give(row, "runs(...)", !row.runs.empty());
    row.runs = option.names;
    row.too_many_runs = option.too_many;
}

} // namespace detail

/// Declares a thread of the machine; in virtual time, its share of that time.
template <class... Options>
constexpr ActivityRow activity(std::string_view name, const Options&... options) {
    ActivityRow row{.name = name};
    (detail::apply(row, options), ...);
    return row;
}

} // namespace tappet
