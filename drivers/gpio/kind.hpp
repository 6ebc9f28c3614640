// A GPIO chip in the rows of boards and bindings, and the checks of the table.
#pragma once

#include "kernel/base/nearest.hpp"
#include "kernel/component/device_kind.hpp"

namespace tappet {

namespace gpio {

inline constexpr Word lines_word{.name = "lines", .kind = "gpio", .is_for_box = true};
inline constexpr Word line_word{.name = "line", .kind = "gpio", .is_of_parts = true};

/// Returns the offset on the chip of the line with that name; the table's check has made sure that it exists.
constexpr unsigned offset_of(std::span<const Fact> bound, std::string_view line) noexcept {
    return static_cast<unsigned>(said(bound, line_word, line)->numbers[0]);
}

constexpr Sentence check_chip(const DeviceAsked& asked) {
    const Fact* lines = said(asked.of_board, lines_word);
    const std::int64_t count = lines == nullptr ? 0 : lines->numbers[0];
    if (count == 0)
        return Sentence{
            "device \"", asked.device,
            "\" states no number of lines; add lines(32), or how many it has, to the board's row"};
    for (const auto& wanted : asked.parts) {
        if (said(asked.bound, line_word, wanted) != nullptr) continue;
        Nearest nearest{wanted};
        for (const Fact& line : asked.bound) nearest.consider(line.part);
        Sentence text{"it has no line \"", wanted, "\""};
        tappet::detail::add_suggestion(text, nearest, "add line(\"...\", offset) to it");
        return text;
    }
    for (std::size_t i = 0; i < asked.bound.size(); ++i) {
        const Fact& line = asked.bound[i];
        for (const Fact& other : asked.bound.first(i))
            if (line.numbers == other.numbers || line.part == other.part)
                return Sentence{"lines \"", other.part, "\" and \"", line.part,
                                "\" share a name or an offset; correct one"};
        if (line.numbers[0] >= count)
            return Sentence("line \"", line.part, "\" has offset ", line.numbers[0], " but device \"",
                            asked.device, "\" has lines 0 to ", count - 1, "; correct it");
        bool wanted = false;
        for (const auto& each : asked.parts) wanted |= each == line.part;
        if (!wanted)
            return Sentence{"line \"", line.part,
                            "\" is not in the component's map; add it there or remove it here"};
    }
    return {};
}

inline constexpr DeviceKind device_kind{.name = "gpio", .check = &check_chip};

} // namespace gpio

/// Board row: the number of lines that the GPIO chip has for wires.
constexpr Fact lines(unsigned count) noexcept { return {&gpio::lines_word, {}, {count}}; }
/// Binding row: a line of the map, and its offset on the chip.
constexpr Fact line(std::string_view name, unsigned offset) noexcept {
    return {&gpio::line_word, name, {offset}};
}

} // namespace tappet
