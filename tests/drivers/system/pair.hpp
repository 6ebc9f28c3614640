// Two machines and their crossings: a value, an event, a command, and the presence of the other one.
#pragma once

#include "board/host/board.hpp"
#include "drivers/system/station.hpp"
#include "kernel/machine/accept.hpp"
#include "tests/drivers/system/alone.hpp"

#include <vector>

namespace tappet::pair {

/// Sends what its test sets.
struct Giver {
    Output<double> level{};
    Event<std::int32_t> sent{};
    CommandCall<std::int32_t, std::int32_t&> doubled{};
    Input<bool> other_is_there{};

    double tells = 0;
    std::vector<std::int32_t> to_send{};
    std::int64_t losses = 0;
    std::int32_t asks = 0;
    std::vector<CommandState> states{};

    void step(const Cycle&) noexcept TAPPET_REALTIME {
        level.write(tells);
        if (!to_send.empty()) {
            sent.emit(to_send.front());
            TAPPET_ESCAPE("a test's list", to_send.erase(to_send.begin()));
        }
        if (asks != 0 && !in_flight(doubled.state())) static_cast<void>(doubled.send(std::exchange(asks, 0)));
        if (states.empty() || states.back() != doubled.state())
            TAPPET_ESCAPE("a test's list", states.push_back(doubled.state()));
    }
    void not_taken() noexcept TAPPET_REALTIME { ++losses; }

    static constexpr auto interface() {
        return facets(output<&Giver::level>("level", "mm", "as the test has it"),
                      event<&Giver::sent>("sent", "a number"),
                      sends<&Giver::doubled>("doubled", "twice a number"),
                      input<&Giver::other_is_there>("other_is_there", "", "the taker is heard"),
                      operation<&Giver::not_taken>("not_taken", "an event was lost"));
    }
};

struct Taker {
    Input<double> level{};
    Input<bool> other_is_there{};
    std::vector<std::int32_t> got{};
    int busy_for = 0; ///< cycles that a command takes
    bool refuses = false;

    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    void take(std::int32_t number) noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("a test's list", got.push_back(number));
    }
    bool twice(std::int32_t, std::int32_t&) noexcept TAPPET_REALTIME { return !refuses; }
    CommandProgress twice_done(std::int32_t number, std::int32_t& result) noexcept TAPPET_REALTIME {
        if (busy_for-- > 0) return CommandProgress::executing;
        result = 2 * number;
        return CommandProgress::done;
    }

    static constexpr auto interface() {
        return facets(input<&Taker::level>("level", "mm", "as the giver tells it"),
                      input<&Taker::other_is_there>("other_is_there", "", "the giver is heard"),
                      operation<&Taker::take>("take", "a number"),
                      command<&Taker::twice, &Taker::twice_done>("twice", "twice a number"));
    }
};

// clang-format off
inline constexpr auto giver_table = test::alone<Giver>("giver", "giving", every(5ms), budget(50us));
inline constexpr auto taker_table = test::alone<Taker>("taker", "taking", every(5ms), budget(50us));

template <class... Options>
constexpr WireRow usual_wire(std::string_view name, const Options&... options) {
    return wire(name, bit_rate(500'000), beats(20ms), silent_after(70ms), served_within(1ms, budget(40us)), options...);
}
inline constexpr auto both_nodes = nodes(node<giver_table>("a"), node<taker_table>("b"));
inline constexpr auto level_row = across(data("a.giver.level", "b.taker.level", stale_after(60ms), hold), every(10ms), in_bits(24, 0.1));
inline constexpr auto sent_row = across(when("a.giver.sent", tell("b.taker.take")), at_most(1, 40ms), within(30ms), if_lost("a.giver.not_taken"));
inline constexpr auto doubled_row = across(uses("a.giver.doubled", "b.taker.twice"), at_most(1, 100ms), within(20ms), in_bits(24));
inline constexpr auto b_row = presence("b", "a.giver.other_is_there");
inline constexpr auto a_row = presence("a", "b.taker.other_is_there");
inline constexpr auto pair = system("pair", both_nodes, usual_wire("wire"),
    crossings(level_row, sent_row, doubled_row, b_row, a_row),
    promises(
        reaction("a.giver.sent", "b.taker.take", within(15ms)),
        reaction("a.giver.level", "b.taker.level", within(26ms)),
        stops("a", "b.taker.other_is_there", within(85ms))));
// clang-format on

using GiverFirmware = AtRunTime<station<pair, "a", giver_table>, board::host>;
using TakerFirmware = AtRunTime<station<pair, "b", taker_table>, board::host>;

} // namespace tappet::pair
