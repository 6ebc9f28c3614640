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
    void limit(modbus::LibmodbusTransport& server) const noexcept {
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

// A server may still be answering the machine's last request, or hold its connection: then it is asked again.
void ask(const SafeLine& line) noexcept {
    constexpr int rounds = 6;
    const auto is_here = [&line](const SafeServer& each) { return each.at == line.at; };
    const auto is_asked = [&](const SafeServer& each) {
        return is_here(each) && !each.is_safe && os::Clock::monotonic() < line.end;
    };
    const bool is_shared = std::ranges::count_if(line.servers, is_here) > 1;
    for (int round = 0; round < rounds; ++round) {
        if (std::ranges::none_of(line.servers, is_asked)) break;
        if (round > 1)
            os::sleep_for(std::min<Duration>((round - 1) * 100ms, line.end - os::Clock::monotonic()));
        const bool is_quick = round == 0 && is_shared;
        const Time begin = os::Clock::monotonic();
        const Time round_end = is_quick ? line.end - (line.end - begin) / 2 : line.end;
        const auto is_tried = [&](const SafeServer& each) {
            return is_asked(each) && !(is_quick && each.server->is_serial());
        };
        std::int64_t still_tried = std::ranges::count_if(line.servers, is_tried);
        for (SafeServer& each : line.servers) {
            if (!is_tried(each)) continue;
            const Time now = os::Clock::monotonic();
            // None takes the time of those after it.
            const Time until = now + (round_end - now) / still_tried--;
            each.is_safe = go_on(each, {is_quick ? quick_answer_within : line.end - now, until});
        }
    }
    for (SafeServer& each : line.servers)
        if (is_here(each)) close(each);
}

} // namespace

// A thread for each line, because libmodbus waits for each answer: a dead server would take the time of all
// behind it.
std::size_t write_safe_registers(std::span<SafeServer> servers, std::span<SafeLine> lines, Duration within,
                                 const Meanwhile& meanwhile) noexcept {
    const Time end = os::Clock::monotonic() + within;
    for (SafeServer& each : servers) {
        each.attempt = {};
        each.is_safe = each.writes.requests.empty();
    }
    std::size_t count = 0;
    for (const SafeServer& each : servers) {
        const auto leads_to_it = [&each](const SafeLine& line) { return line.at == each.at; };
        // Not whether it is safe: that is its line's business by now.
        if (each.writes.requests.empty() || std::ranges::any_of(lines.first(count), leads_to_it)) continue;
        SafeLine& line = lines[count++];
        line.servers = servers;
        line.at = each.at;
        line.end = end;
        line.plan = {.name = "safe-registers",
                     .fifo_priority = os::ThreadPlan::as_its_starter,
                     .body = [](void* of) noexcept { ask(*static_cast<SafeLine*>(of)); },
                     .context = &line};
        static_cast<void>(line.thread.start(line.plan).has_value());
    }
    for (SafeLine& line : lines.first(count)) {
        // No memory for one: late, and without `meanwhile`, is better than never.
        if (!line.thread.running()) ask(line);
        while (!line.thread.join_within(50)) meanwhile();
    }
    return static_cast<std::size_t>(std::ranges::count(servers, false, &SafeServer::is_safe));
}

} // namespace tappet
