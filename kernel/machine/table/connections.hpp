// Connection rows: the data flow from outputs to inputs, and the reaction when data stop.
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
    std::uint8_t stale_answers = 0; ///< options that say how a stale value is handled: one at most
    bool wakes_reader = false;
    bool delayed_step = false;
    double scale = 0; ///< 0: none is given
    bool converted = false;
    RateTransition transition = RateTransition::unsaid;
    bool says_age = false;   ///< stale_after(...) is given, with any value
    bool says_scale = false; ///< scaled(...) is given, with any value
};

namespace detail {

/// Returns the number of a constant that the compiler knows, otherwise 0; start-up checks the other constants
/// before it distributes them.
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
/// A value older than `age` (above 0) is stale. hold, substitute(x) or stop_machine state what the reader
/// then gets; default: hold. stop_machine works even when the reader's activity is waiting.
constexpr StaleAfter stale_after(Duration age) noexcept { return {age}; }
/// Stale value: the reader keeps it, and sees that it is stale. A value from another machine is the last that
/// the wire delivered, even when it was forced there.
inline constexpr WhenStale hold = WhenStale::hold;
/// Stale value: the machine stops.
inline constexpr WhenStale stop_machine = WhenStale::stop;
struct Substitute {
    RowValue value;
};
/// The value that the reader gets instead of a stale or never written one: a number, or a constant of the
/// port's type with static storage:
///     const Eigen::Vector3d parked{0, 0, 120};
///     data("arm.pose", "tool.pose", stale_after(4ms), substitute<parked>())
constexpr Substitute substitute(double value) noexcept { return {{.given = true, .number = value}}; }
template <const auto& Constant>
constexpr Substitute substitute() noexcept {
    return {detail::row_constant<Constant>()};
}
/// The value that the reader gets before the first write; spelled like substitute. Default: the row's
/// substitute, otherwise the default of the type.
constexpr RowOption<ConnectionRow, RowValue> initially(double value) noexcept {
    return {&ConnectionRow::before_first, {.given = true, .number = value}};
}
template <const auto& Constant>
constexpr RowOption<ConnectionRow, RowValue> initially() noexcept {
    return {&ConnectionRow::before_first, detail::row_constant<Constant>()};
}
/// Wakes the reader's activity at each write, and when the value becomes stale: that, too, is news.
inline constexpr RowOption wakes{&ConnectionRow::wakes_reader, true};
/// The reader sees the value of the previous cycle: breaks a data-flow cycle inside one activity.
inline constexpr RowOption delayed{&ConnectionRow::delayed_step, true};
struct Scaled {
    double factor;
};
/// The reader gets each value multiplied by `factor`. For floating-point ports; costs one multiplication for
/// each value. Real-time.
constexpr Scaled scaled(double factor) noexcept { return {factor}; }
/// Scales by the factor from the unit of the output to the unit of the input.
inline constexpr RowOption converted{&ConnectionRow::converted, true};
/// Slower writer: the reader gets its last value until the next one arrives. This is the default; rows for
/// commands from one control level to another state it.
inline constexpr RateTransition in_steps = RateTransition::hold;
/// Slower writer of floating-point numbers: linear interpolation from value to value in the reader's cycles;
/// adds a delay of one writer period.
inline constexpr RateTransition interpolated = RateTransition::interpolate;
/// Slower writer of floating-point numbers: extrapolates the line through the last two values for one writer
/// period.
inline constexpr RateTransition extrapolated = RateTransition::extrapolate;
/// Full buffer: the new value is rejected and counted. The default.
inline constexpr Overflow reject_newest = Overflow::reject;
/// Full buffer: the oldest value is dropped and counted.
inline constexpr Overflow drop_oldest = Overflow::drop_oldest;

/// Whether staleness has an effect: the machine stops, or the reader is woken.
constexpr bool is_guarded(const ConnectionRow& row) noexcept {
    return row.max_age > Duration::zero() && (row.when_stale == WhenStale::stop || row.wakes_reader);
}

/// Whether the row generates values between the written ones.
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

/// Connects an output to an input; the reader gets the last value.
template <class... Options>
constexpr ConnectionRow data(std::string_view from, std::string_view to, const Options&... options) {
    ConnectionRow row{.from = from, .to = to};
    (detail::apply(row, options), ...);
    return row;
}

/// Passes every value of a buffered output, in order, to a buffered input; at most Capacity values wait.
template <std::size_t Capacity, class... Options>
constexpr ConnectionRow buffer(std::string_view from, std::string_view to, const Options&... options) {
    ConnectionRow row{.from = from, .to = to, .buffered = true, .capacity = Capacity};
    (detail::apply(row, options), ...);
    return row;
}

} // namespace tappet
