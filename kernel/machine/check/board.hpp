// Checks of a machine against a board and the binding between them: every device and line that a driver names
// is bound to one that the board has, and every row of the binding is of use.
#pragma once

#include "kernel/machine/check/components.hpp"
#include "kernel/machine/table/binding.hpp"
#include "kernel/machine/table/board.hpp"

namespace tappet::checks {

template <class Rows>
constexpr const auto* find_named(const Rows& rows, std::string_view name) noexcept {
    for (const auto& row : rows)
        if (row.name == name) return &row;
    return decltype(&*rows.begin()){nullptr};
}

/// A Modbus server may be reached by an address alone, and datagrams come to one of the box.
constexpr bool has_address(std::string_view device_kind) noexcept {
    return device_kind == "modbus" || device_kind == "udp";
}
/// What on the board drives this kind: a Modbus server, when it is reached by a serial port.
constexpr std::string_view board_kind_of(std::string_view device_kind) noexcept {
    return device_kind == "modbus" ? "serial" : device_kind;
}

/// The port of "192.168.7.2:502", numeric IPv4, as the one way to write it has it; 0: it is not written so.
constexpr int port_of(std::string_view address) noexcept {
    int parts = 0, number = -1;
    for (const char character : address) {
        if (character >= '0' && character <= '9') {
            if (number == 0) return 0; // two ways to write one address would be two devices
            number = (number < 0 ? 0 : number) * 10 + (character - '0');
            if (number > (parts < 4 ? 255 : 65535)) return 0;
        } else if (number >= 0 && character == (parts < 3 ? '.' : ':')) {
            ++parts;
            number = -1;
        } else {
            return 0;
        }
    }
    return parts == 4 && number > 0 ? number : 0;
}

template <class... Words>
constexpr Sentence of_binding(const Board& board, std::string_view device, const Words&... words) {
    return Sentence{"binding to board \"", board.name, "\", wired(\"", device, "\"): ", words...};
}

/// What only one kind of device is told.
constexpr Sentence check_bound_facts(const ComponentRow& row, const Board& board, const BoundDevice& bound) {
    const std::string_view kind = row.type->device_kind;
    if (kind != "gpio" && !bound.lines.empty())
        return of_binding(board, bound.name, "line(\"", bound.lines[0].name,
                          "\") is for a gpio device, and this is a ", kind, " device; remove it");
    if (kind == "modbus" && (bound.unit.number < 1 || bound.unit.number > 255))
        return of_binding(board, bound.name, "unit(", bound.unit.number,
                          ") is no server; write 1 to 247, over TCP also 255");
    if (bound.answer.time <= Duration::zero())
        return of_binding(board, bound.name,
                          "answer_within is not above 0; write for example answer_within(300ms)");
    const SerialLine& serial = bound.serial;
    if ((serial.parity != 'N' && serial.parity != 'E' && serial.parity != 'O') || serial.baud < 300 ||
        serial.stop_bits < 1 || serial.stop_bits > 2)
        return of_binding(board, bound.name,
                          "no serial line is set so; write for example serial_line(19'200, 'E', 1)");
    return {};
}

constexpr Sentence check_bound_lines(const ComponentRow& row, const Board& board, const BoundDevice& bound,
                                     const BoardDevice& device) {
    if (row.type->shares_device) return {}; // its driver has the lines
    for (const auto& wanted : row.type->device_lines) {
        if (find_named(bound.lines, wanted) != nullptr) continue;
        Nearest nearest{wanted};
        for (const auto& line : bound.lines) nearest.consider(line.name);
        Sentence text = of_binding(board, bound.name, "it has no line \"", wanted, "\"");
        detail::add_suggestion(text, nearest, "add line(\"...\", offset) to it");
        return text;
    }
    for (std::size_t i = 0; i < bound.lines.size(); ++i) {
        const BoundLine& line = bound.lines[i];
        for (std::size_t j = 0; j < i; ++j)
            if (line.offset == bound.lines[j].offset || line.name == bound.lines[j].name)
                return of_binding(board, bound.name, "lines \"", bound.lines[j].name, "\" and \"", line.name,
                                  "\" share a name or an offset; correct one");
        if (line.offset >= device.lines)
            return of_binding(board, bound.name, "line \"", line.name, "\" stands at ", line.offset,
                              " but device \"", device.name, "\" has lines 0 to ", device.lines - 1,
                              "; correct it");
        bool wanted = false;
        for (const auto& each : row.type->device_lines) wanted |= each == line.name;
        if (!wanted)
            return of_binding(board, bound.name, "line \"", line.name,
                              "\" is not in the component's map; add it there or remove it here");
    }
    return {};
}

constexpr Sentence check_bound_device(const ComponentRow& row, const Board& board, const BoundDevice& bound) {
    const std::string_view wants = board_kind_of(row.type->device_kind);
    const BoardDevice* device = find_named(board.devices, bound.at);
    if (device == nullptr) {
        if (has_address(row.type->device_kind) && port_of(bound.at) != 0)
            return check_bound_facts(row, board, bound);
        Nearest nearest{bound.at};
        for (const auto& each : board.devices)
            if (each.kind == wants) nearest.consider(each.name);
        Sentence text = of_binding(board, bound.name, "the board has no device \"", bound.at, "\"");
        detail::add_suggestion(
            text, nearest,
            row.type->device_kind == "modbus"
                ? "write a server's address as 192.168.7.2:502, or add a serial port to "
                  "the board's devices"
            : row.type->device_kind == "udp"
                ? "write the box's address and the port as 192.168.7.1:5005, or 0.0.0.0:5005"
                : "add it to the board's devices");
        return text;
    }
    if (device->kind != wants)
        return of_binding(board, bound.name, "it drives a ", row.type->device_kind, " device but \"",
                          device->name, "\" is of kind ", device->kind, "; name another");
    if (Sentence fault = check_bound_facts(row, board, bound); !fault.empty()) return fault;
    if (device->kind == "can" && device->bit_rate.bits_per_second == 0)
        return of_binding(board, bound.name, "device \"", device->name,
                          "\" states no bit rate; add bit_rate(500'000), or what its bus runs at, to the "
                          "board's row");
    if (device->kind == "can" && device->bit_rate.in_data_phase != 0 &&
        device->bit_rate.in_data_phase < device->bit_rate.bits_per_second)
        return of_binding(board, bound.name, "device \"", device->name, "\" has a data phase of ",
                          device->bit_rate.in_data_phase,
                          " bit/s, slower than its arbitration; write the "
                          "faster one as the second, bit_rate(500'000, 2'000'000)");
    if (device->kind == "gpio" && device->lines == 0)
        return of_binding(board, bound.name, "device \"", device->name,
                          "\" states no number of lines; add lines(32), or how many it has, to the board's "
                          "row");
    return device->kind == "gpio" ? check_bound_lines(row, board, bound, *device) : Sentence{};
}

constexpr Sentence check_proof(const MachineView& m, const Board& board, const Proof& proof) {
    if (proof.output.empty()) return {};
    const auto fault = [&](const auto&... words) {
        return Sentence{"binding to board \"", board.name, "\", proven_by(\"",
                        proof.output,          "\"): ",    words...};
    };
    End found{};
    if (const Sentence wrong = resolve(m, proof.output, FacetKind::output, found); !wrong.empty())
        return fault(wrong);
    const Facet& facet = facet_at(m, found);
    if (facet.kind != FacetKind::output || facet.type != type_id<std::int64_t>)
        return fault("it is no output of whole numbers; name one that counts what the machine makes");
    if (proof.count <= 0) return fault("it is shown by nothing; name a count above 0");
    return {};
}

constexpr Sentence check_devices(const MachineView& m, const Board& board, const Binding& binding) {
    if (binding.too_many)
        return Sentence{
            "binding to board \"", board.name,
            "\": it has more rows than a binding holds: 16 devices, 64 placements; raise the bound in "
            "kernel/machine/table/binding.hpp"};
    for (std::size_t c = 0; c < m.components.size(); ++c) {
        const ComponentRow& row = m.components[c];
        if (row.type->device_kind.empty()) continue;
        for (std::size_t j = 0; j < c; ++j)
            if (m.components[j].device == row.device && !row.type->shares_device &&
                !m.components[j].type->shares_device)
                return of_component(row.name, " drives device \"", row.device, "\", as component \"",
                                    m.components[j].name, "\" does; a device has one driver");
        if (row.type->shares_device) {
            bool opened = false;
            for (const auto& other : m.components)
                opened |= other.device == row.device && !other.type->shares_device;
            if (!opened)
                return of_component(row.name, " shares device \"", row.device,
                                    "\", which no component drives; correct the name");
        }
        if (board.simulated) continue;
        const BoundDevice* bound = find_named(binding.devices, row.device);
        if (bound == nullptr) {
            Nearest nearest{row.device};
            for (const auto& each : binding.devices) nearest.consider(each.name);
            Sentence text = of_component(row.name, ": the binding to board \"", board.name,
                                         "\" does not say where device \"", row.device, "\" stands");
            detail::add_suggestion(text, nearest, "add wired(\"...\", \"a device of the board\") to it");
            return text;
        }
        if (const Sentence fault = check_bound_device(row, board, *bound); !fault.empty())
            return of_component(row.name, ": ", fault);
    }
    const auto address_of = [&board](const BoundDevice& bound) {
        const BoardDevice* device = find_named(board.devices, bound.at);
        return device != nullptr && !device->address.empty() ? device->address : bound.at;
    };
    for (std::size_t i = 0; i < binding.devices.size(); ++i) {
        const BoundDevice& bound = binding.devices[i];
        for (std::size_t j = 0; j < i; ++j)
            if (bound.name == binding.devices[j].name || address_of(bound) == address_of(binding.devices[j]))
                return of_binding(board, bound.name, "wired(\"", binding.devices[j].name,
                                  "\") has the same name or the same device of the board; correct one");
        bool driven = false;
        for (const auto& row : m.components) driven |= row.device == bound.name;
        if (!driven)
            return of_binding(board, bound.name,
                              "no component of the machine drives it; correct the name or remove the row");
    }
    return check_proof(m, board, binding.proof);
}

} // namespace tappet::checks
