// Three machines whose history is recorded: two emit and send, the third one serves both with one object.
#pragma once

#include "board/host/board.hpp"
#include "drivers/system/station.hpp"
#include "kernel/machine/accept.hpp"
#include "tests/drivers/system/alone.hpp"
#include "tests/drivers/system/history.hpp"
#include "toolchain/machine/system_run.hpp"

#include <utility>

namespace tappet::trio {

using history::Number;

/// The common record of all three, by the true time.
struct Witness {
    const SystemRun* run = nullptr;
    history::History history{};
    std::vector<Time> levels{}; ///< when the value of this number was written
    std::size_t levels_seen = 0;
    Duration slowest_level{};

    void emitted(std::size_t sender, Number number) {
        history.emitted.push_back({sender, number, run->now()});
    }
    void sent(std::size_t sender, Number number) {
        history.asked.push_back({.sender = sender, .number = number, .invoked = run->now()});
    }
    void ended(Number number, CommandState how, Number result) {
        const auto call = std::ranges::find(history.asked, number, &history::Asked::number);
        call->responded = run->now(), call->how = how, call->result = result;
    }
    void wrote(Number level) { levels.resize(static_cast<std::size_t>(level) + 1, run->now()); }
    /// Everything since the last observed value shows itself now.
    void saw(Number level) {
        const auto seen = static_cast<std::size_t>(level) + 1;
        if (seen > levels_seen && levels_seen != 0)
            slowest_level = std::max(slowest_level, run->now() - levels[levels_seen]);
        levels_seen = std::max(levels_seen, seen);
    }
};

/// Emits and sends, in its next cycle, what its test sets.
struct Sender {
    Output<double> level{};
    Event<Number> sent{};
    CommandCall<Number, Number&> add{};

    Witness* witness = nullptr;
    std::size_t self = 0;
    Number to_emit = 0, to_add = 0; ///< 0: nothing
    Number adds = 0;                ///< in flight
    Number told = 0;                ///< sent as its level

    void step(const Cycle&) noexcept TAPPET_REALTIME {
        if (witness == nullptr) return;
        level.write(static_cast<double>(told));
        if (self == 0) TAPPET_ESCAPE("a test's record", witness->wrote(told));
        ++told;
        if (to_emit != 0) {
            TAPPET_ESCAPE("a test's record", witness->emitted(self, to_emit));
            sent.emit(std::exchange(to_emit, 0));
        }
        if (adds != 0 && !in_flight(add.state())) {
            const Number result = add.state() == CommandState::done ? add.result<0>() : 0;
            TAPPET_ESCAPE("a test's record", witness->ended(adds, add.state(), result));
            adds = 0;
        }
        if (to_add != 0 && adds == 0 && add.send(to_add)) {
            adds = std::exchange(to_add, 0);
            TAPPET_ESCAPE("a test's record", witness->sent(self, adds));
        }
    }
    void not_taken() noexcept TAPPET_REALTIME {
        if (witness != nullptr)
            TAPPET_ESCAPE("a test's record", witness->history.told.push_back({self, witness->run->now()}));
    }

    static constexpr auto interface() {
        return facets(output<&Sender::level>("level", "", "how many cycles it had"),
                      event<&Sender::sent>("sent", "a number"),
                      sends<&Sender::add>("add", "adds a number to the sum"),
                      operation<&Sender::not_taken>("not_taken", "an event was lost"));
    }
};

/// Serves events, and holds a sum to which commands add. A command takes some cycles; some are refused.
struct Taker {
    /// Some take longer than their sender waits for a silent node.
    static constexpr int busy_cycles(Number number) { return number % 8 == 7 ? 20 : number % 4; }
    static constexpr bool refuses(Number number) { return number % 16 == 15; }

    Input<double> level{};
    Witness* witness = nullptr;
    Number sum = 0;
    std::map<Number, int> left{}; ///< cycles left of commands in flight

    void step(const Cycle&) noexcept TAPPET_REALTIME {
        double value = 0;
        if (witness != nullptr && level.read(value) == Flow::fresh)
            TAPPET_ESCAPE("a test's record", witness->saw(static_cast<Number>(value)));
    }
    void take(Number number) noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("a test's record", witness->history.served.push_back({number, witness->run->now()}));
    }
    bool begin_add(Number number, Number&) noexcept TAPPET_REALTIME {
        const bool refused = refuses(number);
        TAPPET_ESCAPE("a test's record", left[number] = busy_cycles(number);
                      witness->history.begun.push_back({number, witness->run->now(), refused}));
        return !refused;
    }
    CommandProgress added(Number number, Number& result) noexcept TAPPET_REALTIME {
        bool is_over = false;
        TAPPET_ESCAPE("a test's list", is_over = left[number]-- == 0);
        if (!is_over) return CommandProgress::executing;
        result = sum += number;
        TAPPET_ESCAPE("a test's record",
                      witness->history.executed.push_back({number, result, witness->run->now()}));
        return CommandProgress::done;
    }

    static constexpr auto interface() {
        return facets(input<&Taker::level>("level", "", "as the first one tells it"),
                      operation<&Taker::take>("take", "a number"),
                      command<&Taker::begin_add, &Taker::added>("add", "adds a number to the sum"));
    }
};

// clang-format off
inline constexpr auto sender_table = test::alone<Sender>("sender", "sending", every(5ms), budget(50us), deadline(500us));
inline constexpr auto taker_table = test::alone<Taker>("taker", "taking", every(5ms), budget(50us), deadline(500us));

inline constexpr auto trio = system("trio",
    nodes(node<sender_table>("one"), node<sender_table>("two"), node<taker_table>("taker")),
    wire("wire", bit_rate(500'000), bus_errors(1, 20ms), beats(20ms), silent_after(70ms), served_within(300us, budget(20us))),
    crossings(
        across(data("one.sender.level", "taker.taker.level", stale_after(60ms), hold), every(10ms), in_bits(24)),
        across(when("one.sender.sent", tell("taker.taker.take")), at_most(1, 40ms), within(30ms), if_lost("one.sender.not_taken")),
        across(when("two.sender.sent", tell("taker.taker.take")), at_most(1, 40ms), within(30ms), if_lost("two.sender.not_taken")),
        across(uses("one.sender.add", "taker.taker.add"), at_most(1, 40ms), within(30ms), in_bits(24)),
        across(uses("two.sender.add", "taker.taker.add"), at_most(1, 40ms), within(30ms), in_bits(24))),
    promises(
        reaction("one.sender.level", "taker.taker.level", within(30ms)),
        reaction("one.sender.sent", "taker.taker.take", within(15ms)),
        reaction("two.sender.sent", "taker.taker.take", within(15ms)),
        reaction("one.sender.add", "taker.taker.add", within(15ms)),
        reaction("two.sender.add", "taker.taker.add", within(15ms))));
// clang-format on
inline constexpr std::size_t taker_node = 2;

using OneFirmware = AtRunTime<station<trio, "one", sender_table>, board::host>;
using TwoFirmware = AtRunTime<station<trio, "two", sender_table>, board::host>;
using TakerFirmware = AtRunTime<station<trio, "taker", taker_table>, board::host>;

} // namespace tappet::trio
