// A Modbus RTU server that answers anything at any moment: an accepted answer is one that it sent for that
// question, with its unit, function, count, place and checksum; no call blocks its caller beyond the stated
// time; and the rounds after the noise succeed.
//
// A list of steps answers each question: a byte that selects the action, followed by the bytes that the
// action consumes.
#include "drivers/modbus/libmodbus_transport.hpp"
#include "drivers/modbus/session.hpp"
#include "tests/fuzz/input.hpp"
#include "tests/fuzz/serial_line.hpp"

namespace {

using namespace tappet;
using namespace tappet::modbus;
using namespace tappet::fuzz;

constexpr Duration patience = 10ms, silence = 1750us;
constexpr auto map = register_map(
    read("inputs", input_registers(10, 3), every(20ms), word("a", 0), float_word("b", 1)),
    read("contacts", discrete_inputs(4, 11), every(30ms), bit("first", 0), bit("last", 10)),
    write("valves", holding_registers(20, 2), every(40ms), stale_after(10s), word("a", 0).safe(0),
          word("b", 1).safe(0)),
    write("lamps", coils(3, 2), every(40ms), stale_after(10s), bit("a", 0).safe(0), bit("b", 1).safe(0)));
static_assert(map.fault.empty());

/// The transport, and the demands on it.
class Judged final : public Transport {
public:
    explicit Judged(Transport& of) : of_{of} {}
    Answer connect() noexcept override { return of_.connect(); }
    void disconnect() noexcept override { of_.disconnect(); }
    bool recover() noexcept override { return of_.recover(); }
    Answer read(Table table, std::uint16_t address, std::span<std::uint16_t> values) noexcept override {
        const Time began = line->now;
        const Answer answer = of_.read(table, address, values);
        if (judge(answer, began)) return answer;
        demand(line->taken[2] == line->taken.size() - 5);
        for (std::size_t i = 0; i < values.size(); ++i) {
            const std::uint8_t* const from = line->taken.data() + 3;
            demand(values[i] ==
                   (holds_bits(table) ? from[i / 8] >> i % 8 & 1 : from[2 * i] << 8 | from[2 * i + 1]));
        }
        demand(line->taken[2] == (holds_bits(table) ? (values.size() + 7) / 8 : 2 * values.size()));
        return answer;
    }
    Answer write(Table table, std::uint16_t address,
                 std::span<const std::uint16_t> values) noexcept override {
        const Time began = line->now;
        const Answer answer = of_.write(table, address, values);
        if (judge(answer, began)) return answer;
        demand(line->taken.size() == 8 &&
               std::equal(line->taken.begin(), line->taken.begin() + 6, line->asked.begin()));
        return answer;
    }

private:
    /// Returns true when no byte was accepted: there is nothing more to judge.
    bool judge(const Answer& answer, Time began) {
        const Line& at = *line;
        demand(at.now - began <= 2 * patience + 10us && at.asked_at >= quiet_until_);
        const bool is_exception = answer.outcome == Outcome::exception;
        const bool is_answered = answer.outcome == Outcome::ok || is_exception;
        quiet_until_ = at.now + (is_answered ? silence : patience);
        if (!is_answered) return true;
        demand(at.first_taken_at >= at.asked_at && at.taken.size() >= 5 && at.taken[0] == at.asked[0]);
        demand(at.taken[1] == (at.asked[1] | (is_exception ? 0x80 : 0)));
        Bytes sealed{at.taken.begin(), at.taken.end() - 2};
        seal(sealed);
        demand(sealed == at.taken);
        if (is_exception) demand(at.taken.size() == 5 && at.taken[2] == answer.exception);
        return is_exception;
    }
    Transport& of_;
    Time quiet_until_{};
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const std::string terminal = a_terminal();
    Line here{.script = {{data, size}}, .now = Time{1s}};
    LibmodbusTransport transport;
    demand(transport.open({.line = Serial{terminal, 115200, 'N', 1}, .unit = 17, .answer_within = patience})
               .has_value());
    line = &here;
    {
        Judged judged{transport};
        Session<map.rows.size(), map.registers.size()> session{map, judged, {.first = 5ms, .most = 20ms}};
        const auto step = [&] {
            for (const std::size_t v : {4u, 5u, 6u, 7u}) session.set(v, here.questions >> v & 1, here.now);
            const Time next = session.step(here.now);
            here.now = std::max(here.now, next);
            for (std::size_t v = 0; v < map.registers.size(); ++v)
                demand(session.value(v).quality != Quality::good || is_number(session.value(v).value));
        };
        for (int steps = 0; !here.script.rest.empty() && steps < 2000; ++steps) step();
        here.script = {};
        const Time end = here.now;
        const std::uint64_t answers = session.counters().answers, requests = session.counters().requests;
        while (here.now < end + 150ms) step();
        const Counters& now = session.counters();
        demand(now.requests - requests - (now.answers - answers) <= 1); // the one that is flushed
        for (const std::size_t v : {0u, 2u, 3u})
            demand(session.value(v).quality == Quality::good && session.value(v).stamp > here.now - 100ms);
        demand(!session.outage() && session.trouble() == Trouble{});
    }
    line = nullptr;
    return 0;
}
