// A Modbus server, reached by Ethernet or by a serial port of the board.
#include "drivers/hardware/open.hpp"
#include "kernel/machine/check/board.hpp"
#include "kernel/os/clock.hpp"
#include "kernel/os/sleep.hpp"

#include <algorithm>
#include <utility>

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

/// How long each call of one share may take.
struct Patience {
    Duration each;
    Time end;
    const Meanwhile& meanwhile;
    void limit(modbus::LibmodbusTransport& server) const noexcept {
        meanwhile();
        server.wait_at_most(std::min(each, end - os::Clock::monotonic()));
    }
};

void close(SafeServer& to) noexcept {
    if (std::exchange(to.attempt.is_connected, false)) to.server->disconnect();
}

// A server is safe when it confirmed all requests on one connection: a server that lost its connection may
// have restarted. The request that was lost is sent first on the next connection, and the earlier ones
// follow. A connection without a single answer ends the round. A refused request holds up no other one. Many
// requests take longer than a share of the time: the next round goes on where this one stopped. It stops
// between two requests, because an answer that is still to come would be lost with the connection.
bool go_on(SafeServer& to, const Patience& patience) noexcept {
    SafeServer::Attempt& attempt = to.attempt;
    const std::size_t count = to.writes.requests.size();
    bool is_refused = false;
    for (std::size_t asked = 0; attempt.confirmed < count; ++asked) {
        if (asked == 4 * count || (is_refused && asked >= count)) return false;
        if (asked != 0 && patience.end - os::Clock::monotonic() < attempt.took) return false;
        patience.limit(*to.server);
        if (!attempt.is_connected) {
            if (to.server->connect().outcome != modbus::Outcome::ok) return false;
            attempt.is_connected = true;
            attempt.answers = 0;
            patience.limit(*to.server);
        }
        const modbus::SafeWrite& each = to.writes.requests[attempt.next];
        const modbus::Answer answer =
            to.server->write(each.run.table, static_cast<std::uint16_t>(each.run.address),
                             to.writes.words.subspan(each.first, each.run.count));
        const bool is_ok = answer.outcome == modbus::Outcome::ok;
        is_refused = is_refused || answer.outcome == modbus::Outcome::exception;
        attempt.confirmed = is_ok ? attempt.confirmed + 1 : 0;
        if (is_ok || answer.outcome == modbus::Outcome::exception) {
            ++attempt.answers;
            attempt.took = answer.took;
            attempt.next = (attempt.next + 1) % count;
            continue;
        }
        close(to);
        if (answer.outcome == modbus::Outcome::timeout || attempt.answers == 0) return false;
    }
    close(to); // it may be the only one that a gateway has for several
    return true;
}

// It may be about to start.
void pause(Duration length, Time end, const Meanwhile& meanwhile) noexcept {
    for (const Time until = std::min(os::Clock::monotonic() + length, end);;) {
        meanwhile();
        const Duration left = until - os::Clock::monotonic();
        if (left <= Duration::zero()) return;
        os::sleep_for(std::min<Duration>(left, 100ms));
    }
}

} // namespace

// A server may still be answering the machine's last request, or hold its connection: then it is asked again.
std::size_t write_safe_registers(std::span<SafeServer> servers, Duration within,
                                 const Meanwhile& meanwhile) noexcept {
    constexpr int rounds = 6;
    const Time end = os::Clock::monotonic() + within;
    std::size_t left = 0;
    for (SafeServer& each : servers) {
        each.attempt = {};
        each.is_safe = each.writes.requests.empty();
        left += each.is_safe ? 0u : 1u;
    }
    for (int round = 0; round < rounds && left != 0 && os::Clock::monotonic() < end; ++round) {
        if (round > 1) pause((round - 1) * 100ms, end, meanwhile);
        const bool is_quick = round == 0;
        const Time round_end = is_quick ? end - within / 2 : end;
        const auto is_tried = [is_quick](const SafeServer& each) {
            return !each.is_safe && !(is_quick && each.server->is_serial());
        };
        std::int64_t still_tried = std::ranges::count_if(servers, is_tried);
        for (SafeServer& each : servers) {
            if (!is_tried(each)) continue;
            const Time now = os::Clock::monotonic();
            if (now >= end) break;
            // None takes the time of those after it.
            const Time until = now + (round_end - now) / still_tried--;
            each.is_safe = go_on(each, {is_quick ? quick_answer_within : within, until, meanwhile});
            left -= each.is_safe ? 1u : 0u;
        }
    }
    for (SafeServer& each : servers) close(each);
    return left;
}

} // namespace tappet
