// A GPIO chip, opened for the lines of its driver's line map, each where the binding says.
#include "drivers/hardware/open.hpp"
#include "kernel/machine/check/board.hpp"

namespace tappet {

std::expected<void, Sentence> open_device(gpio::Lines& chip, PlacedLines& lines, const BoundTo& to) {
    const auto& map = *static_cast<const std::span<const gpio::LineRow>*>(to.row.type->device_map);
    gpio::place(
        map, [&to](std::string_view name) { return checks::find_named(to.bound.lines, name)->offset; },
        lines);
    return chip.open({to.address(), std::span{lines}.first(map.size())});
}

} // namespace tappet
