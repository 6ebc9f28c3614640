// Checks of a machine against a board: every device and line that a driver names exists there and is of its
// kind.
#pragma once

#include "kernel/machine/check/components.hpp"
#include "kernel/machine/table/board.hpp"

namespace tappet::checks {

constexpr const BoardDevice* find_device(const Board& board, std::string_view name) noexcept {
    for (const auto& device : board.devices)
        if (device.name == name) return &device;
    return nullptr;
}

constexpr Sentence check_devices(const MachineView& m, const Board& board) {
    for (std::size_t c = 0; c < m.components.size(); ++c) {
        const ComponentRow& row = m.components[c];
        if (row.type->device_kind.empty()) continue;
        const BoardDevice* device = find_device(board, row.device);
        if (device == nullptr) {
            Nearest nearest{row.device};
            for (const auto& each : board.devices)
                if (each.kind == row.type->device_kind) nearest.consider(each.name);
            Sentence text =
                of_component(row.name, ": board \"", board.name, "\" has no device \"", row.device, "\"");
            detail::add_suggestion(text, nearest, "add it to the board's devices");
            return text;
        }
        if (device->kind != row.type->device_kind)
            return of_component(row.name, " drives a ", row.type->device_kind, " device but \"", row.device,
                                "\" of board \"", board.name, "\" is of kind ", device->kind,
                                "; name another");
        if (device->kind == "can" && device->bit_rate.bits_per_second == 0)
            return of_component(
                row.name, ": device \"", row.device, "\" of board \"", board.name,
                "\" states no bit rate; add bit_rate(500'000), or what its bus runs at, to it");
        for (std::size_t j = 0; j < c; ++j)
            if (m.components[j].device == row.device && !row.type->shares_device &&
                !m.components[j].type->shares_device)
                return of_component(row.name, " drives device \"", row.device, "\", as component \"",
                                    m.components[j].name, "\" does; a device has one driver");
        for (const auto& wanted : row.type->device_lines) {
            bool found = false;
            Nearest nearest{wanted};
            for (const auto& line : device->lines) found |= line.name == wanted, nearest.consider(line.name);
            if (found) continue;
            Sentence text = of_component(row.name, ": device \"", row.device, "\" of board \"", board.name,
                                         "\" has no line \"", wanted, "\"");
            detail::add_suggestion(text, nearest, "add line(\"...\", offset) to it");
            return text;
        }
        for (std::size_t i = 0; i < device->lines.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                if (device->lines[i].offset == device->lines[j].offset ||
                    device->lines[i].name == device->lines[j].name)
                    return of_component(row.name, ": lines \"", device->lines[j].name, "\" and \"",
                                        device->lines[i].name, "\" of device \"", row.device,
                                        "\" of board \"", board.name,
                                        "\" share a name or an offset; correct one");
    }
    return {};
}

} // namespace tappet::checks
