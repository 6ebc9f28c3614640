// Any frames on the wire between two machines: damaged, repeated, or forged with valid protection, while
// either machine restarts. Damaged frames are counted and change nothing; no event is accepted twice; a
// forged frame affects only its own values; and afterwards all rows across the wire work again.
//
// Each step is a byte that selects the action, followed by the bytes that the action consumes.
#include "tests/drivers/system/pair.hpp"
#include "tests/fuzz/input.hpp"
#include "toolchain/machine/system_run.hpp"

#include <algorithm>
#include <cmath>

namespace {

using namespace tappet;
using tappet::fuzz::demand;
using namespace tappet::pair;
constexpr auto& plan = systems::plan_of<tappet::pair::pair>;
constexpr auto all = [] {
    std::array<can::Identifier, plan.frames.size()> identifiers{};
    for (std::size_t f = 0; f < identifiers.size(); ++f) identifiers[f] = {plan.frames[f].id, false};
    return identifiers;
}();

struct Wire {
    std::array<AcceptedMachine, 2> machines{GiverFirmware::machine(), TakerFirmware::machine()};
    SystemRun run{tappet::pair::pair.view(), machines, {}, 1};
    can::Twin liar{}, spy{};
    std::array<can::Frame, 16> heard{}; ///< the last ones, for repetition
    std::size_t hears = 0;
    std::int32_t sent = 0;
    std::size_t lies = 0;
    bool began_anew = false;

    Wire() {
        demand(liar.open({.interface = "liar", .transmit = all}).has_value());
        demand(spy.open({.interface = "spy", .receive = all}).has_value());
        demand(run.wire().attach(liar) && run.wire().attach(spy) && run.start());
        wait(200ms);
    }
    Giver& giver() { return *run.instance(0).find<Giver>("giver"); }
    Taker& taker() { return *run.instance(1).find<Taker>("taker"); }
    void wait(Duration time, bool is_ours = false) {
        demand(run.run_for(time));
        can::Frame frame;
        while (liar.receive(frame).what != can::Received::none) {
        }
        while (spy.receive(frame).what == can::Received::frame)
            if (!is_ours) heard[hears++ % heard.size()] = frame;
    }
    void put(can::Frame frame) {
        frame.stamp = run.now() + 1ns;
        static_cast<void>(liar.send(frame, can::Keep::every));
        liar.service(run.now());
        wait(5ms, true);
    }
    /// Damages one bit of a heard frame on its way.
    void damage(std::size_t which, std::span<const std::uint8_t> bit) {
        can::Frame frame = heard[which];
        if (frame.length == 0 || bit.empty()) return;
        const unsigned at = bit[0] % (8u * frame.length);
        frame.data[at / 8] ^= static_cast<std::uint8_t>(1u << at % 8);
        const std::int64_t before = refused();
        put(frame);
        demand(refused() == before + 1);
    }
    std::int64_t refused() {
        return run.instance(0).find<systems::Link<tappet::pair::pair, 0>>("wire")->frames_refused.last() +
               run.instance(1).find<systems::Link<tappet::pair::pair, 1>>("wire")->frames_refused.last();
    }
    /// Forgets the machine: neither its memory nor its components' heap is ever released.
    void forget() {
        giver().to_send = std::vector<std::int32_t>{};
        giver().states = std::vector<CommandState>{};
        taker().got = std::vector<std::int32_t>{};
    }
    void begin_anew(std::size_t node, bool says_so) {
        says_so ? run.stop(node) : run.kill(node);
        wait(5ms);
        forget();
        began_anew = true;
        demand(run.start(node).has_value());
    }
    void look() {
        const double level = taker().level.get();
        demand(std::abs(level) <= 0.1 * (1 << 23));
        if (lies == 0) demand(level >= 0.0 && level <= sent + 1.0);
        const auto& got = taker().got;
        if (lies == 0) demand(std::ranges::adjacent_find(got, std::greater_equal{}) == got.end());
        demand(got.size() <= static_cast<std::size_t>(sent) + lies);
    }
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Wire wire;
    fuzz::Script script{{data, size}};
    for (int steps = 0; !script.rest.empty() && steps < 60; ++steps) {
        const std::uint8_t what = script.next(1)[0];
        const WireFrame& as = plan.frames[what % plan.frames.size()];
        can::Frame frame;
        frame.id = as.id;
        frame.length = as.bytes;
        switch (what >> 5) {
        case 0: // anything
            frame.length = std::min<std::uint8_t>(as.bytes, what & 7);
            std::ranges::copy(script.next(8), frame.data.begin());
            wire.put(frame);
            wire.lies += frame.length == as.bytes ? 1 : 0;
            break;
        case 1: // a lie
            std::ranges::copy(script.next(8), frame.data.begin());
            demand(protect(std::span{frame.data}.first(frame.length),
                           {.form = Protection::Form::id_both, .id = as.data_id}, frame.data[1] % 15));
            ++wire.lies;
            wire.put(frame);
            break;
        case 2: wire.put(wire.heard[what % wire.heard.size()]); break;
        case 3: wire.damage(what % wire.heard.size(), script.next(1)); break;
        case 4: wire.giver().to_send.push_back(++wire.sent); break;
        case 5: wire.giver().tells = wire.sent + 1.0, wire.giver().asks = what & 0xF; break;
        case 6: wire.begin_anew(what & 1, (what & 2) != 0); break;
        default: wire.wait(Duration{2ms} * (what & 0x1F));
        }
        wire.look();
    }
    wire.wait(100ms);
    // A lie in the right session may claim that messages were given up, and a repeated beat of an earlier
    // start makes one end restart its count: both end with the session.
    if (wire.lies != 0 || wire.began_anew) wire.begin_anew(0, true);
    wire.wait(300ms);
    wire.giver().tells = 5.0;
    wire.giver().to_send = {1000};
    wire.giver().asks = 21;
    wire.wait(300ms);
    demand(wire.giver().other_is_there.get() && wire.taker().other_is_there.get());
    demand(std::abs(wire.taker().level.get() - 5.0) < 0.06);
    demand(!wire.taker().got.empty() && wire.taker().got.back() == 1000);
    demand(wire.giver().doubled.state() == CommandState::done && wire.giver().doubled.result<0>() == 42);
    wire.run.stop();
    wire.forget();
    return 0;
}
