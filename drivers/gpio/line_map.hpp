// The lines a machine uses of one GPIO chip, by logical name: the machine says what they are, the board says
// where they are.
#pragma once

#include "drivers/gpio/device.hpp"
#include "drivers/map/rows.hpp"
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
    bool says_safe = false;
};

struct Debounce {
    Duration time{};
};
/// Counts an edge only when the level has been stable for this time.
constexpr Debounce debounce(Duration time) noexcept { return {time}; }
struct ActiveLow {};
/// The line is active when its wire is low.
inline constexpr ActiveLow active_low{};
struct Safe {
    bool active = false;
};
/// Sets an output's value before the machine arms, when it stops and when its process has ended; true for a
/// brake that must hold then. Every output must state it.
constexpr Safe safe(bool active) noexcept { return {active}; }

namespace detail {

constexpr void apply(LineRow& row, Debounce option) noexcept { row.line.debounce = option.time; }
constexpr void apply(LineRow& row, ActiveLow) noexcept { row.line.active_low = true; }
constexpr void apply(LineRow& row, Bias option) noexcept { row.line.bias = option; }
constexpr void apply(LineRow& row, Safe option) noexcept {
    row.line.safe_value = option.active;
    row.says_safe = true;
}

template <class... Options>
constexpr LineRow row(std::string_view name, Role role, Driven driven, Options... options) {
    LineRow row;
    row.line.name = name;
    row.line.role = role;
    row.driven = driven;
    (apply(row, options), ...);
    return row;
}

} // namespace detail

/// A line that is read: its level, and its edges with their times.
template <class... Options> constexpr LineRow sensor(std::string_view name, Options... options) {
    return detail::row(name, Role::input, Driven::by_port, options...);
}
/// A line that follows an input port of the component: lamps, contactors.
template <class... Options> constexpr LineRow output(std::string_view name, Options... options) {
    return detail::row(name, Role::output, Driven::by_port, options...);
}
/// A line that events set and clear: valves and brakes that act at an angle.
template <class... Options> constexpr LineRow actuator(std::string_view name, Options... options) {
    return detail::row(name, Role::output, Driven::by_events, options...);
}

template <std::size_t N> struct LineMap {
    std::array<LineRow, N> rows{};
    Sentence fault{}; ///< empty when the map is correct

    [[nodiscard]] constexpr std::size_t index(std::string_view name) const noexcept {
        return index_of(name, N, [this](std::size_t i) { return MapName{{}, rows[i].line.name}; });
    }
};

/// Makes a map and checks it at compile time: static_assert(map.fault.empty()).
template <class... Rows> constexpr LineMap<sizeof...(Rows)> line_map(const Rows&... rows) {
    LineMap<sizeof...(Rows)> map{{rows...}, {}};
    static_assert(sizeof...(Rows) >= 2,
                  "with one line alone in a request the kernel hides the edges it lost: take two");
    static_assert(sizeof...(Rows) <= most_lines, "one request of the kernel holds at most 64 lines");
    for (std::size_t i = 0; i < map.rows.size(); ++i) {
        const Line& line = map.rows[i].line;
        const bool driven = line.role == Role::output;
        if (driven && !map.rows[i].says_safe)
            map.fault =
                Sentence{"output \"", line.name,
                         "\" does not say its safe value: write gpio::safe(false) or gpio::safe(true)"};
        if (!driven && map.rows[i].says_safe)
            map.fault = Sentence{"sensor \"", line.name, "\" has a safe value: only outputs have one"};
        for (std::size_t j = 0; j < i; ++j)
            if (line.name == map.rows[j].line.name)
                map.fault = Sentence{"line \"", line.name, "\" appears twice in the map: rename one of them"};
    }
    return map;
}

/// Writes the map's lines as a chip request, each at the offset that `offset_of(name)` returns.
template <class OffsetOf>
constexpr void place(std::span<const LineRow> map, OffsetOf&& offset_of, std::span<Line> lines) {
    for (std::size_t i = 0; i < map.size(); ++i) {
        lines[i] = map[i].line;
        lines[i].offset = offset_of(map[i].line.name);
    }
}

} // namespace tappet::gpio
