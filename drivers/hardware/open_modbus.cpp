// A Modbus server, reached by Ethernet or by a serial port of the board.
#include "drivers/hardware/open.hpp"
#include "kernel/machine/check/board.hpp"

namespace tappet {

std::expected<void, Sentence> open_device(modbus::LibmodbusTransport& server, const BoundTo& to) {
    modbus::TransportSettings settings;
    settings.unit = to.bound.unit.number;
    settings.answer_within = to.bound.answer.time;
    if (to.device != nullptr) {
        const SerialLine& line = to.bound.serial;
        settings.line = modbus::Serial{to.address(), line.baud, line.parity, line.stop_bits};
    } else {
        const std::string_view address = to.address();
        settings.line = modbus::Tcp{address.substr(0, address.find(':')),
                                    static_cast<std::uint16_t>(checks::tcp_port_of(address))};
    }
    return server.open(settings);
}

bool write_safe_registers(modbus::LibmodbusTransport& server, const modbus::SafeWrites& writes) noexcept {
    if (writes.requests.empty()) return true;
    bool good = server.connect().outcome == modbus::Outcome::ok;
    for (const modbus::SafeWrite& each : writes.requests)
        good = good && server.write(each.run.table, static_cast<std::uint16_t>(each.run.address),
                                    writes.words.subspan(each.first, each.run.count))
                               .outcome == modbus::Outcome::ok;
    server.disconnect();
    return good;
}

} // namespace tappet
