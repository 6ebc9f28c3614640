// Any frames at any times to an SDO client with a transfer under way and to a server: they use only data that
// the other end sent, in the order of CiA 301; each transfer ends; and afterwards a correct one succeeds.
//
// Each step is a byte that selects the action, followed by the bytes that the action consumes.
#include "drivers/canopen/sdo_client.hpp"
#include "tests/fuzz/sdo_objects.hpp"

namespace {

using namespace tappet;
using namespace tappet::fuzz;

struct Connection {
    SdoClient client{};
    SdoServer server{};
    Objects objects{};
    Time now{}, asked{};
    Address at{};
    bool writes = false;
    Bytes wanted{};
    Frames requests{}, answers{}; ///< of this transfer; the last answer before the next request counts

    void begin(bool to_write, Address of, std::span<const std::uint8_t> value) {
        writes = to_write, at = of, wanted.assign(value.begin(), value.end());
        requests.clear(), answers.clear();
        to_write ? client.write(of, value) : client.read(of);
    }
    void send() {
        sdo::Payload request;
        const bool aborts = client.state() == SdoClient::State::aborted;
        if (!client.next(request, now) || aborts) return;
        asked = now;
        requests.push_back(request);
        answers.emplace_back();
        demand(requests.size() <= 2 + sdo::most_bytes); // each request brings data
    }
    [[nodiscard]] bool awaits_answer() const {
        sdo::Payload ignored;
        SdoClient copy = client;
        return client.state() == SdoClient::State::busy && !copy.next(ignored, now);
    }
    void hear(const sdo::Payload& answer) {
        if (awaits_answer()) answers.back() = answer;
        client.take(answer);
        judge();
    }
    void wait(Duration time) {
        now += time;
        const bool is_late = awaits_answer() && now - asked > 100ms;
        client.tick(now);
        if (is_late) demand(client.state() == SdoClient::State::aborted);
        judge();
    }
    void judge() const {
        if (client.state() == SdoClient::State::aborted) demand(client.why() != SdoAbort::none);
        if (client.state() != SdoClient::State::done) return;
        const sdo::Payload &first = requests[0], &confirmed = answers[0];
        const auto rest = [](const Frames& of) { return std::span{of}.subspan(1); };
        demand(sdo::address_in(first) == at && sdo::address_in(confirmed) == at &&
               confirmed[0] >> 5 == (writes ? 3 : 2));
        Bytes moved;
        const bool is_whole = is_expedited(writes ? first : confirmed, moved);
        demand(is_whole ? requests.size() == 1
                        : are_segments(writes ? first : confirmed, rest(writes ? requests : answers), moved));
        demand(std::ranges::equal(moved, writes ? std::span<const std::uint8_t>{wanted} : client.value()));
        for (std::size_t i = 1; i < requests.size(); ++i) // each carries its own toggle bit
            demand((requests[i][0] >> 4 & 1u) == (answers[i][0] >> 4 & 1u) &&
                   (!writes || answers[i][0] >> 5 == 1));
    }
    bool serve(const sdo::Payload& request, sdo::Payload& answer) {
        if (request[0] >> 5 != 0) objects.heard.clear();
        objects.heard.push_back(request);
        return server.serve(request, objects, answer);
    }
    void carry(bool to_write, Address of, std::span<const std::uint8_t> value) {
        begin(to_write, of, value);
        sdo::Payload answer;
        for (int i = 0; i < 30 && client.state() == SdoClient::State::busy; ++i) {
            send();
            if (serve(requests.back(), answer)) hear(answer);
        }
        demand(client.state() == SdoClient::State::done);
    }
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Connection c;
    Script script{{data, size}};
    sdo::Payload last{};
    for (int steps = 0; !script.rest.empty() && steps < 300; ++steps) {
        const std::uint8_t what = script.next(1)[0];
        const Address of{static_cast<std::uint16_t>(0x2000 + (what & 3u)),
                         static_cast<std::uint8_t>((what & 0x1F) == 0x1F ? 1 : 0)};
        const auto change = static_cast<std::uint8_t>((what & 0x10) != 0 ? 1u << (what & 7u) : 0u);
        sdo::Payload frame{}, answer{};
        switch (what >> 5) {
        case 0: c.begin(false, of, {}); break;
        case 1: {
            const auto value = script.next(1 + 4u * (what >> 2 & 7u));
            if (!value.empty()) c.begin(true, of, value);
            break;
        }
        case 2: // to the client, anything
        case 3: // to the server
            std::ranges::copy(script.next(8), frame.begin());
            (what >> 5) == 2 ? c.hear(last = frame) : static_cast<void>(c.serve(frame, answer));
            break;
        case 4: c.wait(Duration{10ms} * (what & 0x1F)); break;
        case 5: // the server's answer, changed or not, once or twice
            if (c.requests.empty() || !c.serve(c.requests.back(), last)) break;
            last[0] ^= change;
            c.hear(last);
            if ((what & 8) != 0) c.hear(last);
            break;
        case 6: // time passes, perhaps too much
            for (int times = what & 0xF; times >= 0; --times) {
                last[0] ^= what & 0x10;
                c.hear(last);
                c.send();
            }
            break;
        default:
            if (!c.requests.empty()) static_cast<void>(c.serve(c.requests.back(), answer)); // is lost
        }
        if (what != 0xFF) c.send();
    }
    c.send();
    c.wait(101ms);
    demand(c.client.state() != SdoClient::State::busy);
    const Bytes value(20, static_cast<std::uint8_t>(size));
    c.carry(true, 0x2000, value);
    c.carry(false, 0x2000, {});
    demand(std::ranges::equal(c.client.value(), value));
    return 0;
}
