// A Modbus server, reached by Ethernet or by a serial port of the board.
#include "drivers/hardware/open.hpp"
#include "kernel/machine/check/board.hpp"
#include "kernel/os/clock.hpp"
#include "kernel/os/sleep.hpp"

#include <algorithm>

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

namespace {

/// How long each call of one attempt may take.
struct Patience {
    Duration each;
    Time end;
    const Meanwhile& meanwhile;
    void limit(modbus::LibmodbusTransport& server) const noexcept {
        meanwhile();
        server.wait_at_most(std::min(each, end - os::Clock::monotonic()));
    }
};

// Each request is tried: one that is refused keeps no other from being safe, and all are tried again. After
// anything worse the server is given up for this time, and the next one goes on where this one stopped: many
// requests take more than a share.
bool try_once(SafeServer& to, const Patience& patience) noexcept {
    patience.limit(*to.server);
    if (to.server->connect().outcome != modbus::Outcome::ok) return false;
    bool good = true;
    for (const modbus::SafeWrite& each : to.writes.requests.subspan(to.confirmed)) {
        patience.limit(*to.server);
        const auto outcome = to.server
                                 ->write(each.run.table, static_cast<std::uint16_t>(each.run.address),
                                         to.writes.words.subspan(each.first, each.run.count))
                                 .outcome;
        good = good && outcome == modbus::Outcome::ok;
        if (good) ++to.confirmed;
        if (outcome != modbus::Outcome::ok && outcome != modbus::Outcome::exception) break;
    }
    to.server->disconnect();
    return good;
}

} // namespace

// A server may still be answering the machine's last request, or hold its connection: then it is asked again.
std::size_t write_safe_registers(std::span<SafeServer> servers, Duration within,
                                 const Meanwhile& meanwhile) noexcept {
    constexpr int rounds = 4;
    const Time end = os::Clock::monotonic() + within;
    std::size_t left = 0;
    for (SafeServer& each : servers) {
        each.confirmed = 0;
        each.is_safe = each.writes.requests.empty();
        left += each.is_safe ? 0u : 1u;
    }
    for (int round = 0; round < rounds && left != 0; ++round) {
        if (round > 1) os::sleep_for(100ms);
        const bool is_quick = round == 0;
        const Time round_end = is_quick ? end - within / 2 : end;
        const auto is_tried = [is_quick](const SafeServer& each) {
            return !each.is_safe && !(is_quick && each.server->is_serial());
        };
        std::int64_t still_tried = std::ranges::count_if(servers, is_tried);
        for (SafeServer& each : servers) {
            if (!is_tried(each)) continue;
            const Time now = os::Clock::monotonic();
            if (now >= end) return left;
            // None takes the time of those after it.
            const Time until = now + (round_end - now) / still_tried--;
            each.is_safe = try_once(each, {is_quick ? quick_answer_within : within, until, meanwhile});
            left -= each.is_safe ? 1u : 0u;
        }
    }
    return left;
}

} // namespace tappet
