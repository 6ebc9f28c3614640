// A Modbus server, reached by Ethernet or by a serial port of the board.
#include "drivers/hardware/open.hpp"
#include "kernel/machine/check/board.hpp"
#include "kernel/os/sleep.hpp"

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
                                    static_cast<std::uint16_t>(checks::port_of(address))};
    }
    return server.open(settings);
}

// A server may still be answering the machine's last request, or hold its connection: then it is asked again.
bool write_safe_registers(modbus::LibmodbusTransport& server, const modbus::SafeWrites& writes) noexcept {
    constexpr int attempts = 3;
    bool good = writes.requests.empty();
    for (int attempt = 0; attempt < attempts && !good; ++attempt) {
        if (attempt != 0) os::sleep_for(100ms);
        if (server.connect().outcome != modbus::Outcome::ok) continue;
        good = true; // and each is tried: one that is refused keeps no other from being safe
        for (const modbus::SafeWrite& each : writes.requests)
            good = server.write(each.run.table, static_cast<std::uint16_t>(each.run.address),
                                writes.words.subspan(each.first, each.run.count))
                           .outcome == modbus::Outcome::ok &&
                   good;
        server.disconnect();
    }
    return good;
}

} // namespace tappet
