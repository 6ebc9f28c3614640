// A Modbus server in the rows of a binding, and the checks of the table.
#pragma once

#include "kernel/base/time.hpp"
#include "kernel/component/device_kind.hpp"

namespace tappet {

namespace modbus {

inline constexpr Word unit_word{.name = "unit", .kind = "modbus"};
inline constexpr Word answer_within_word{.name = "answer_within", .kind = "modbus"};
inline constexpr Word serial_line_word{.name = "serial_line", .kind = "modbus"};

/// A binding's facts about a server.
struct ServerFacts {
    int unit = 1; ///< 1 to 247, over TCP also 255
    Duration answer_within = 300ms;
    int baud = 19200;
    char parity = 'E'; ///< 'N', 'E' or 'O'
    int stop_bits = 1;
};
constexpr ServerFacts server_facts(std::span<const Fact> bound) noexcept {
    ServerFacts server;
    if (const Fact* unit = said(bound, unit_word); unit != nullptr)
        server.unit = static_cast<int>(unit->numbers[0]);
    if (const Fact* answer = said(bound, answer_within_word); answer != nullptr)
        server.answer_within = Duration{answer->numbers[0]};
    if (const Fact* line = said(bound, serial_line_word); line != nullptr) {
        server.baud = static_cast<int>(line->numbers[0]);
        server.parity = static_cast<char>(line->numbers[1]);
        server.stop_bits = static_cast<int>(line->numbers[2]);
    }
    return server;
}

constexpr Sentence check_server(const DeviceAsked& asked) {
    const ServerFacts server = server_facts(asked.bound);
    if (server.unit < 1 || server.unit > 255)
        return Sentence{"unit(", server.unit, ") is not a server address; write 1 to 247, over TCP also 255"};
    if (server.answer_within <= Duration::zero())
        return Sentence{"answer_within is not above 0; write for example answer_within(300ms)"};
    if ((server.parity != 'N' && server.parity != 'E' && server.parity != 'O') || server.baud < 300 ||
        server.stop_bits < 1 || server.stop_bits > 2)
        return Sentence{"no serial line has these settings; write for example serial_line(19'200, 'E', 1)"};
    return {};
}

inline constexpr DeviceKind device_kind{
    .name = "modbus",
    .carrier = "serial",
    .takes_address = true,
    .cure = "write a server's address as 192.168.7.2:502, or add a serial port to the board's devices",
    .check = &check_server};

} // namespace modbus

/// The unit address of a Modbus server: 1..247, over TCP also 255.
constexpr Fact unit(int number) noexcept { return {&modbus::unit_word, {}, {number}}; }
/// The time-out of a Modbus client for an answer; 300 ms unless stated.
constexpr Fact answer_within(Duration time) noexcept {
    return {&modbus::answer_within_word, {}, {time.count()}};
}
/// Baud, parity ('N', 'E' or 'O') and stop bits of a serial line; 19200, 'E', 1 unless stated.
constexpr Fact serial_line(int baud, char parity, int stop_bits) noexcept {
    return {&modbus::serial_line_word, {}, {baud, parity, stop_bits}};
}

} // namespace tappet
