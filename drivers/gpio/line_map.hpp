// The lines a machine uses of one GPIO chip, by logical name: what they are is the machine's, where they lie
// is the board's.
#pragma once

#include "drivers/gpio/device.hpp"
#include "kernel/base/text.hpp"
#include "kernel/base/time.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace tappet::gpio {

/// How the machine drives an output: from an input port, or by operations that events call.
enum class Driven : std::uint8_t { by_port, by_events };

struct LineRow {
    Line line{};
    Driven driven = Driven::by_port;
};

struct Debounce {
    Duration time{};
};
constexpr Debounce debounce(Duration time) noexcept { return {time}; }
struct ActiveLow {};
inline constexpr ActiveLow active_low{};
struct SafeHigh {};
/// The output's safe value is active: a brake that must hold when the machine is gone.
inline constexpr SafeHigh safe_high{};

namespace detail {

constexpr void apply(Line& line, Debounce option) noexcept { line.debounce = option.time; }
constexpr void apply(Line& line, ActiveLow) noexcept { line.active_low = true; }
constexpr void apply(Line& line, SafeHigh) noexcept { line.safe_value = true; }
constexpr void apply(Line& line, Bias option) noexcept { line.bias = option; }

template <class... Options>
constexpr LineRow row(std::string_view name, Role role, Driven driven, Options... options) {
    LineRow row;
    row.line.name = name;
    row.line.role = role;
    row.driven = driven;
    (apply(row.line, options), ...);
    return row;
}

} // namespace detail

template <class... Options> constexpr LineRow sensor(std::string_view name, Options... options) {
    return detail::row(name, Role::input, Driven::by_port, options...);
}
/// Follows an input port of the component: lamps, contactors.
template <class... Options> constexpr LineRow output(std::string_view name, Options... options) {
    return detail::row(name, Role::output, Driven::by_port, options...);
}
/// Set and cleared by events: valves and brakes, which act at an angle.
template <class... Options> constexpr LineRow actuator(std::string_view name, Options... options) {
    return detail::row(name, Role::output, Driven::by_events, options...);
}

template <std::size_t N> struct LineMap {
    std::array<LineRow, N> rows{};
    Sentence fault{}; ///< empty when the map is right

    [[nodiscard]] constexpr std::size_t index(std::string_view name) const noexcept {
        for (std::size_t i = 0; i < N; ++i)
            if (rows[i].line.name == name) return i;
        return N;
    }
};

/// Checks what the compiler can: static_assert(map.fault.empty()).
template <class... Rows> constexpr LineMap<sizeof...(Rows)> line_map(const Rows&... rows) {
    LineMap<sizeof...(Rows)> map{{rows...}, {}};
    static_assert(sizeof...(Rows) >= 2,
                  "with one line alone in a request the kernel hides the edges it lost: take two");
    static_assert(sizeof...(Rows) <= most_lines, "one request of the kernel holds at most 64 lines");
    for (std::size_t i = 0; i < map.rows.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (map.rows[i].line.name == map.rows[j].line.name)
                map.fault = Sentence{"line \"", map.rows[i].line.name,
                                     "\" stands in the map twice: rename one of them"};
    return map;
}

/// The lines of a map as they are requested of a chip, each at the offset that `offset_of(name)` answers.
template <class OffsetOf>
constexpr void place(std::span<const LineRow> map, OffsetOf&& offset_of, std::span<Line> lines) {
    for (std::size_t i = 0; i < map.size(); ++i) {
        lines[i] = map[i].line;
        lines[i].offset = offset_of(map[i].line.name);
    }
}

} // namespace tappet::gpio
