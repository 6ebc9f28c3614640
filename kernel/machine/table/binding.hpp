// A binding: where one machine's devices and lines stand on one board, and which of its processors run which
// activities. The machine's table names devices, the board has them; only here both are known.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/base/time.hpp"

#include <cstdint>
#include <string_view>

namespace tappet {

/// A line of a GPIO chip: the name in the machine's line map, the offset on this board's chip.
struct BoundLine {
    std::string_view name{};
    unsigned offset = 0;
};

/// The address of a Modbus server: 1 to 247, over TCP also 255.
struct ServerUnit {
    int number = 1;
};

/// How long a Modbus client waits for an answer.
struct AnswerWithin {
    Duration time{};
};

/// What a serial line is set to.
struct SerialLine {
    int baud = 19200;
    char parity = 'E'; ///< 'N', 'E' or 'O'
    int stop_bits = 1;
};

struct BoundDevice {
    std::string_view name{}; ///< logical: what the machine's table says
    std::string_view at{};   ///< the board's device; of a Modbus server on Ethernet its "192.168.7.2:502"
    Bounded<BoundLine, 64> lines{};
    ServerUnit unit{};
    SerialLine serial{};
    AnswerWithin answer{std::chrono::milliseconds{300}};
};

/// The processor that an activity is bound to.
struct Placement {
    std::string_view activity{};
    int processor = 0;
};

/// What shows that a new version works on its box: this output has counted so far, and no deadline was
/// missed.
struct Proof {
    std::string_view output{}; ///< of whole numbers: "weft.picks_woven"; "": a minute of running shows it
    std::int64_t count = 0;
};

struct Binding {
    Bounded<BoundDevice, 16> devices{};
    Bounded<Placement, 64> placement{};
    Proof proof{};
    bool too_many = false; ///< more rows than there is room for: the check refuses it
};

/// Of a machine without devices, whose activities all run on the board's default processor; and of any
/// machine on a simulated board.
inline constexpr Binding unbound{};

/// A line of the map, and its offset on the chip.
constexpr BoundLine line(std::string_view name, unsigned offset) noexcept { return {name, offset}; }
/// The address of a Modbus server: 1 to 247, over TCP also 255.
constexpr ServerUnit unit(int number) noexcept { return {number}; }
/// How long a Modbus client waits for an answer; 300 ms unless stated.
constexpr AnswerWithin answer_within(Duration time) noexcept { return {time}; }
/// Baud, parity ('N', 'E' or 'O') and stop bits of a serial line.
constexpr SerialLine serial_line(int baud, char parity, int stop_bits) noexcept {
    return {baud, parity, stop_bits};
}
/// The processor of an activity; the board's default unless stated.
constexpr Placement place(std::string_view activity, int processor) noexcept { return {activity, processor}; }

/// proven_by("weft.picks_woven", 100): a new version stays on its box after that.
constexpr Proof proven_by(std::string_view output, std::int64_t count) noexcept { return {output, count}; }

namespace detail {

constexpr bool add(BoundDevice& device, const BoundLine& line) { return device.lines.push(line); }
constexpr bool add(BoundDevice& device, ServerUnit unit) { return device.unit = unit, true; }
constexpr bool add(BoundDevice& device, AnswerWithin answer) { return device.answer = answer, true; }
constexpr bool add(BoundDevice& device, SerialLine serial) { return device.serial = serial, true; }
constexpr bool add(Binding& binding, const BoundDevice& device) { return binding.devices.push(device); }
constexpr bool add(Binding& binding, const Placement& place) { return binding.placement.push(place); }
constexpr bool add(Binding& binding, const Proof& proof) { return binding.proof = proof, true; }

} // namespace detail

/// wired("loom-can", "can0")
/// wired("loom-io", "io", line("brake", 9), ...)
/// wired("loom-utility", "192.168.7.2:502", unit(1), answer_within(300ms))
/// wired("loom-utility", "serial1", unit(1), serial_line(19'200, 'E', 1))
template <class... Facts>
constexpr BoundDevice wired(std::string_view name, std::string_view at, const Facts&... facts) {
    BoundDevice device{.name = name, .at = at};
    (static_cast<void>(detail::add(device, facts)), ...);
    return device;
}

/// binding(wired(...), ..., place("can", 3), ..., proven_by("weft.picks_woven", 100))
template <class... Rows>
constexpr Binding binding(const Rows&... rows) {
    Binding binding;
    ((binding.too_many |= !detail::add(binding, rows)), ...);
    return binding;
}

} // namespace tappet
