// Activity rows: the threads of the machine, what makes each run, and what it may take.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/base/row_option.hpp"
#include "kernel/base/time.hpp"

#include <cstdint>
#include <optional>
#include <string_view>

namespace tappet {

// A receiver marks each sending activity, and the requests of what sees the machine, in one 64-bit word.
inline constexpr std::size_t max_activities = 63;

enum class Trigger : std::uint8_t { every, on_work, on_device, background };
enum class WhenLate : std::uint8_t { count, stop };

struct ActivityRow {
    static constexpr std::size_t max_runs = 64;
    std::string_view name{};
    Trigger trigger = Trigger::background;
    Duration period{};          ///< of every; of background: how often it looks
    Duration phase{};           ///< of every: after the points of the grid that all periods have
    std::string_view device{};  ///< of on_device: the component whose device wakes it
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
    std::string_view twice{}; ///< the option that the row was given twice

    [[nodiscard]] constexpr Duration shortest_period() const noexcept {
        return trigger == Trigger::every ? period : at_most_per;
    }
    [[nodiscard]] constexpr Duration deadline() const noexcept {
        return deadline_after.count() != 0 ? deadline_after : shortest_period();
    }
    /// Real-time functions need less: they call no library that takes much stack.
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
/// Each of its periods begins so much later than those of activities without a phase: behind what it reads.
constexpr Phase phase(Duration after) noexcept { return {after}; }
/// Periodic. Without not_real_time it needs a budget; its deadline is the period unless stated. The periods
/// of all activities begin on one grid, whenever each was started: those of 1 ms and of 3 ms meet every 3 ms.
constexpr TriggerOption every(Duration period, Phase phase = {}) noexcept {
    return {Trigger::every, period, {}, phase.after};
}
/// Sporadic: runs when a message, a connection that wakes, or a timer of its components asks. Needs at_most.
constexpr TriggerOption on_work() noexcept { return {Trigger::on_work, {}, {}}; }
/// Sporadic: runs when the device of this component is ready. Needs at_most.
constexpr TriggerOption on_device(std::string_view component) noexcept {
    return {Trigger::on_device, {}, component};
}

struct AtMost {
    std::int64_t n;
    Duration per;
};
/// At most n wakes in any window of this length: what the schedulability analysis believes.
constexpr AtMost at_most(std::int64_t n, Duration per) noexcept { return {n, per}; }

struct Budget {
    Duration each;
};
/// Processor time of one cycle, synchronous reactions included: what the schedulability analysis believes.
constexpr Budget budget(Duration each) noexcept { return {each}; }
/// From the release to the end of the cycle; the period, or that of at_most, unless stated. The shorter, the
/// higher the priority.
constexpr RowOptionOnce<ActivityRow, Duration> deadline(Duration after) noexcept {
    return {&ActivityRow::deadline_after, after, "a deadline"};
}
struct NotRealTime {};
/// May block; runs below every real-time activity, without budget or deadline.
inline constexpr NotRealTime not_real_time{};
/// The stack of its thread, at least 16 KiB. Without this row option it is 32 KiB, and 64 KiB if the activity
/// is not_real_time. Its lowest page is a guard: a thread that runs into it stops the machine.
constexpr RowOption<ActivityRow, std::optional<std::size_t>> stack(std::size_t bytes) noexcept {
    return {&ActivityRow::stack, bytes};
}
/// A missed deadline stops the machine; without this it is counted and reported.
inline constexpr RowOption stop_when_late{&ActivityRow::when_late, WhenLate::stop};

struct Runs {
    Bounded<std::string_view, ActivityRow::max_runs> names{};
    bool too_many = false;
};
/// The components that it runs, 64 at most; their order follows from the data flow.
template <class... Names>
constexpr Runs runs(const Names&... names) {
    Runs row;
    ((row.too_many |= !row.names.push(std::string_view{names})), ...);
    return row;
}

namespace detail {

constexpr void apply(ActivityRow& row, const TriggerOption& option) noexcept {
    give(row, "a trigger", row.has_trigger);
    row.trigger = option.trigger == Trigger::every && !row.real_time ? Trigger::background : option.trigger;
    row.period = option.period;
    row.phase = option.phase;
    row.device = option.device;
    row.has_trigger = true;
}
constexpr void apply(ActivityRow& row, AtMost option) noexcept {
    give(row, "at_most", row.at_most_per != Duration::zero());
    row.at_most_n = option.n;
    row.at_most_per = option.per;
}
constexpr void apply(ActivityRow& row, Budget option) noexcept {
    give(row, "a budget", row.budget_each != Duration::zero());
    row.budget_each = option.each;
}
constexpr void apply(ActivityRow& row, NotRealTime) noexcept {
    row.real_time = false;
    if (row.trigger == Trigger::every) row.trigger = Trigger::background;
}
constexpr void apply(ActivityRow& row, const Runs& option) noexcept {
    give(row, "runs", !row.runs.empty());
    row.runs = option.names;
    row.too_many_runs = option.too_many;
}

} // namespace detail

/// A thread of the machine, or its share of virtual time.
template <class... Options>
constexpr ActivityRow activity(std::string_view name, const Options&... options) {
    ActivityRow row{.name = name};
    (detail::apply(row, options), ...);
    return row;
}

} // namespace tappet
