// Connection rows: what flows from an output to an input, and what happens when it does not.
#pragma once

#include "kernel/base/number.hpp"
#include "kernel/base/row_option.hpp"
#include "kernel/base/time.hpp"
#include "kernel/component/port.hpp"
#include "kernel/exchange/ring.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <type_traits>

namespace tappet {

struct ConnectionRow {
    std::string_view from{};
    std::string_view to{};
    bool buffered = false;
    std::size_t capacity = 0;
    Overflow overflow = Overflow::reject;
    Duration max_age{};
    WhenStale when_stale = WhenStale::hold;
    RowValue substitute{};
    RowValue before_first{};
    std::uint8_t stale_answers = 0; ///< options that say what a stale value means: one at most
    bool wakes_reader = false;
    bool delayed_step = false;
    double scale = 0; ///< 0: none is given
    bool converted = false;
    RateTransition transition = RateTransition::unsaid;
    bool says_age = false;   ///< stale_after(...), whatever it says
    bool says_scale = false; ///< scaled(...), likewise
};

namespace detail {

/// What the compiler knows of a constant's number; of others start-up asks before it gives them out.
template <const auto& Constant>
constexpr double known_number() noexcept {
    if constexpr (std::is_floating_point_v<std::remove_cvref_t<decltype(Constant)>>)
        if constexpr (requires { typename std::bool_constant<is_number(Constant)>; }) return Constant;
    return 0.0;
}
template <const auto& Constant>
constexpr RowValue row_constant() noexcept {
    return {.given = true,
            .number = known_number<Constant>(),
            .constant = std::addressof(Constant),
            .type = type_id<std::remove_cvref_t<decltype(Constant)>>};
}

} // namespace detail

struct StaleAfter {
    Duration age;
};
/// A value older than this, which is above 0, is stale; hold, substitute(x) or stop_machine say what the
/// reader then gets: hold, if nothing says so. stop_machine is kept whatever the reader's activity waits for.
constexpr StaleAfter stale_after(Duration age) noexcept { return {age}; }
/// Of a stale value: the reader keeps it, and sees that it is stale. From another machine it is the last that
/// came over the wire, also when that was forced there.
inline constexpr WhenStale hold = WhenStale::hold;
/// Of a stale value: the machine stops.
inline constexpr WhenStale stop_machine = WhenStale::stop;
struct Substitute {
    RowValue value;
};
/// What the reader gets instead of a stale or never written value: a number, or a constant of the port's
/// type, which has static storage:
///     const Eigen::Vector3d parked{0, 0, 120};
///     data("arm.pose", "tool.pose", stale_after(4ms), substitute<parked>())
constexpr Substitute substitute(double value) noexcept { return {{.given = true, .number = value}}; }
template <const auto& Constant>
constexpr Substitute substitute() noexcept {
    return {detail::row_constant<Constant>()};
}
/// What the reader gets before the first value; spelled as substitute. Without it that is the row's
/// substitute, or the type's own default.
constexpr RowOption<ConnectionRow, RowValue> initially(double value) noexcept {
    return {&ConnectionRow::before_first, {.given = true, .number = value}};
}
template <const auto& Constant>
constexpr RowOption<ConnectionRow, RowValue> initially() noexcept {
    return {&ConnectionRow::before_first, detail::row_constant<Constant>()};
}
/// Each write wakes the reader's activity, and so does a value that grows stale: that, too, is news.
inline constexpr RowOption wakes{&ConnectionRow::wakes_reader, true};
/// The reader sees the value of the previous cycle: breaks a data-flow cycle inside one activity.
inline constexpr RowOption delayed{&ConnectionRow::delayed_step, true};
struct Scaled {
    double factor;
};
/// The reader gets each value times `factor`. Ports of floating numbers; in real time one multiplication for
/// each value.
constexpr Scaled scaled(double factor) noexcept { return {factor}; }
/// Likewise, and the factor leads from the unit of the output to the unit of the input.
inline constexpr RowOption converted{&ConnectionRow::converted, true};
/// Of a slower writer: the reader gets its last value until the next one comes. What is done when nothing is
/// said; commands from one level of control to another say it.
inline constexpr RateTransition in_steps = RateTransition::hold;
/// Of a slower writer, of floating numbers: a line from value to value, in the reader's own cycles; later by
/// one of the writer's periods.
inline constexpr RateTransition interpolated = RateTransition::interpolate;
/// Likewise: the line through the last two values, for one of the writer's periods.
inline constexpr RateTransition extrapolated = RateTransition::extrapolate;
/// Of a full buffer: what comes is not taken, and counted. The default.
inline constexpr Overflow reject_newest = Overflow::reject;
/// Of a full buffer: what waits longest gives way, and is counted.
inline constexpr Overflow drop_oldest = Overflow::drop_oldest;

/// Whether somebody acts when the value grows stale: the machine stops, or the reader is woken.
constexpr bool is_guarded(const ConnectionRow& row) noexcept {
    return row.max_age > Duration::zero() && (row.when_stale == WhenStale::stop || row.wakes_reader);
}

/// Whether values are made between those that are written.
constexpr bool has_values_between(const ConnectionRow& row) noexcept {
    return row.transition == RateTransition::interpolate || row.transition == RateTransition::extrapolate;
}
constexpr bool is_scaled(const ConnectionRow& row) noexcept { return row.scale != 0 || row.converted; }

namespace detail {

constexpr void apply(ConnectionRow& row, Scaled option) noexcept {
    row.scale = option.factor;
    row.says_scale = true;
}
constexpr void apply(ConnectionRow& row, StaleAfter option) noexcept {
    row.max_age = option.age;
    row.says_age = true;
}
constexpr void apply(ConnectionRow& row, WhenStale option) noexcept {
    row.when_stale = option;
    ++row.stale_answers;
}
constexpr void apply(ConnectionRow& row, Substitute option) noexcept {
    row.when_stale = WhenStale::substitute;
    row.substitute = option.value;
    ++row.stale_answers;
}
constexpr void apply(ConnectionRow& row, RateTransition option) noexcept { row.transition = option; }
constexpr void apply(ConnectionRow& row, Overflow option) noexcept { row.overflow = option; }

} // namespace detail

/// The last value of an output, for an input.
template <class... Options>
constexpr ConnectionRow data(std::string_view from, std::string_view to, const Options&... options) {
    ConnectionRow row{.from = from, .to = to};
    (detail::apply(row, options), ...);
    return row;
}

/// Every value of a buffered output, in order, for a buffered input; at most Capacity wait.
template <std::size_t Capacity, class... Options>
constexpr ConnectionRow buffer(std::string_view from, std::string_view to, const Options&... options) {
    ConnectionRow row{.from = from, .to = to, .buffered = true, .capacity = Capacity};
    (detail::apply(row, options), ...);
    return row;
}

} // namespace tappet
