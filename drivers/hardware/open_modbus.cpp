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

void pause(Duration length, Time end, const Meanwhile& meanwhile) noexcept {
    for (const Time until = std::min(os::Clock::monotonic() + length, end);;) {
        meanwhile();
        const Duration left = until - os::Clock::monotonic();
        if (left <= Duration::zero()) return;
        os::sleep_for(std::min<Duration>(left, 50ms));
    }
}

// A server is safe when it confirmed all requests on one connection: a server that lost its connection may
// have restarted. The request that was lost is sent first on the next connection, and the earlier ones
// follow. A refused request holds up no other one. Who does not answer may be about to start, may still be
// answering the machine's last request, or hold its connection: it is asked until the time is over. The
// first request of a connection has half of that: it may be lost.
void make_safe(SafeServer& to, Time end, const Meanwhile& meanwhile) noexcept {
    constexpr Duration longest_rest = 400ms;
    const std::size_t count = to.writes.requests.size();
    std::size_t next = 0, confirmed = 0, asked = 0;
    std::size_t answers = 0; // on this connection
    bool is_connected = false, is_refused = false;
    Duration rest{};
    const auto take_a_rest = [&] {
        pause(rest, end, meanwhile);
        rest = std::min<Duration>(rest + 100ms, longest_rest);
    };
    for (Time now; confirmed < count && (now = os::Clock::monotonic()) < end;) {
        meanwhile();
        to.server->wait_at_most(answers == 0 ? (end - now) / 2 : end - now);
        if (!is_connected) {
            is_connected = to.server->connect().outcome == modbus::Outcome::ok;
            if (!is_connected) take_a_rest();
            continue;
        }
        const modbus::SafeWrite& each = to.writes.requests[next];
        const modbus::Answer answer =
            to.server->write(each.run.table, static_cast<std::uint16_t>(each.run.address),
                             to.writes.words.subspan(each.first, each.run.count));
        const bool is_ok = answer.outcome == modbus::Outcome::ok;
        confirmed = is_ok ? confirmed + 1 : 0;
        if (!is_ok && answer.outcome != modbus::Outcome::exception) {
            to.server->disconnect();
            is_connected = false;
            if (std::exchange(answers, 0) == 0) take_a_rest();
            continue;
        }
        ++answers;
        next = (next + 1) % count;
        is_refused = is_refused || !is_ok;
        if (++asked % count == 0 && std::exchange(is_refused, false)) take_a_rest();
    }
    if (is_connected) to.server->disconnect();
    to.is_safe = confirmed == count;
}

} // namespace

// A thread for each, because libmodbus waits for an answer: a dead server would take the time of all behind
// it.
std::size_t write_safe_registers(std::span<SafeServer> servers, Duration within,
                                 const Meanwhile& meanwhile) noexcept {
    const Time end = os::Clock::monotonic() + within;
    const auto waits = [](const SafeServer& each) { return !each.is_safe && !each.thread.running(); };
    for (SafeServer& each : servers) {
        each.is_safe = false;
        each.end = end;
        each.plan = {.name = "safe-registers",
                     .fifo_priority = os::ThreadPlan::as_its_starter,
                     .body =
                         [](void* of) noexcept {
                             auto& server = *static_cast<SafeServer*>(of);
                             make_safe(server, server.end, {});
                         },
                     .context = &each};
        static_cast<void>(each.thread.start(each.plan).has_value());
    }
    // The box refuses threads: these share the time that there is, until it is over.
    while (os::Clock::monotonic() < end && std::ranges::any_of(servers, waits)) {
        std::int64_t left = std::ranges::count_if(servers, waits);
        for (SafeServer& each : servers) {
            if (!waits(each)) continue;
            const Time now = os::Clock::monotonic();
            make_safe(each, now + (end - now) / left--, meanwhile);
        }
    }
    for (SafeServer& each : servers)
        while (!each.thread.join_within(50)) meanwhile();
    return static_cast<std::size_t>(std::ranges::count(servers, false, &SafeServer::is_safe));
}

} // namespace tappet
