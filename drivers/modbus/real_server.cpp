// Opens a server by its binding, and writes its safe registers.
#include "drivers/modbus/real_server.hpp"

#include "kernel/base/address.hpp"
#include "kernel/os/clock.hpp"
#include "kernel/os/sleep.hpp"

#include <algorithm>
#include <utility>

namespace tappet::modbus {

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
// have restarted. The lost request is sent first on the next connection, and the earlier ones follow. A
// refused request does not stop the others. A server that does not answer may be starting, may still be
// answering the machine's last request, or may hold its connection: it is retried until the time is over. The
// first request of a connection gets half of that time, because it may be lost.
bool make_safe(LibmodbusTransport& server, const SafeWrites& writes, Time end,
               const Meanwhile& meanwhile) noexcept {
    constexpr Duration longest_rest = 400ms;
    const std::size_t count = writes.requests.size();
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
        server.wait_at_most(answers == 0 ? (end - now) / 2 : end - now);
        if (!is_connected) {
            is_connected = server.connect().outcome == Outcome::ok;
            if (!is_connected) take_a_rest();
            continue;
        }
        const SafeWrite& each = writes.requests[next];
        const Answer answer = server.write(each.run.table, static_cast<std::uint16_t>(each.run.address),
                                           writes.words.subspan(each.first, each.run.count));
        const bool is_ok = answer.outcome == Outcome::ok;
        confirmed = is_ok ? confirmed + 1 : 0;
        if (!is_ok && answer.outcome != Outcome::exception) {
            server.disconnect();
            is_connected = false;
            if (std::exchange(answers, 0) == 0) take_a_rest();
            continue;
        }
        ++answers;
        next = (next + 1) % count;
        is_refused = is_refused || !is_ok;
        if (++asked % count == 0 && std::exchange(is_refused, false)) take_a_rest();
    }
    if (is_connected) server.disconnect();
    return confirmed == count;
}

} // namespace

std::expected<void, Sentence> RealServer::open(const DevicePlace& place) {
    safe_ = static_cast<const SafeWrites*>(place.map);
    address_ = place.address;
    is_serial_ = place.is_on_board;
    const ServerFacts facts = server_facts(place.bound);
    TransportSettings settings;
    settings.unit = facts.unit;
    settings.answer_within = facts.answer_within;
    if (is_serial_)
        settings.line = Serial{address_, facts.baud, facts.parity, facts.stop_bits};
    else
        settings.line = Tcp{host_of(address_), static_cast<std::uint16_t>(port_of(address_))};
    return server_.open(settings);
}

void RealServer::report(os::ArmingReport& report, std::string_view name) {
    if (is_serial_) return; // a serial line opens even without a server
    const Sentence who{"Modbus server \"", name, "\" at \"", address_, "\""};
    if (server_.connect().outcome == Outcome::ok)
        report.passed("modbus-server", Sentence{who, " answers"});
    else
        report.warning(
            "modbus-server", Sentence{who, " does not answer"},
            Sentence{"switch it on, or correct its address in the binding; the machine keeps trying"});
    server_.disconnect();
}

bool RealServer::make_safe_requests(Time end, const Meanwhile& meanwhile) noexcept {
    return make_safe(server_, *safe_, end, meanwhile);
}

} // namespace tappet::modbus
