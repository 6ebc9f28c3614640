// One life of the three machines: their events and commands, the faults meanwhile, and the observations.
#pragma once

#include "tests/drivers/system/trio.hpp"

#include <gtest/gtest.h>

namespace tappet::trio {

/// The faults that a run may meet.
struct Weather {
    bool drifts = true; ///< clocks drift, and each starts at any time
    bool spoils = true; ///< a frame, as often as the wire's bus_errors(...) allow
    bool omits = false, doubles = false, kills = false, cuts = false;
    bool crowds = false; ///< each node sends as much as allowed, all of it in one cycle
};

inline constexpr std::size_t row_count = trio.crossings.size();

/// The longest times, to compare with the proven ones in a run whose frames all arrive.
struct Longest {
    std::array<Duration, row_count> served{};   ///< of each row, from writing, emission or sending
    std::array<Duration, row_count> answered{}; ///< of commands, without the cycles that they take
    std::array<double, systems::plan_of<trio>.frames.size()> frames{}; ///< divided by the proven time

    void merge(const Longest& other) {
        for (std::size_t x = 0; x < row_count; ++x) {
            served[x] = std::max(served[x], other.served[x]);
            answered[x] = std::max(answered[x], other.answered[x]);
        }
        for (std::size_t f = 0; f < frames.size(); ++f) frames[f] = std::max(frames[f], other.frames[f]);
    }
};

class Story {
public:
    static constexpr std::size_t first_event = 1, first_command = 3; ///< crossings, of either sender
    // And one more cycle of the sender: a request is emitted or sent in the next one.
    static constexpr Duration pause = trio.crossings[first_event].at_most_per + 5ms;
    static constexpr Duration reader =
        sender_table.activities[0].period + sender_table.activities[0].deadline();

    Story(std::uint64_t seed, const Weather& weather)
        : random_{seed}, weather_{weather}, run_{trio.view(), machines_, {}, seed} {
        witness_.run = &run_;
        history().receiver = taker_node;
        history().times = {.event = trio.crossings[first_event].within,
                           .command = trio.crossings[first_command].within,
                           .reader = reader,
                           .drift = 10us};
        history().lives.resize(nodes);
        for (const ChannelRow& row : channels)
            history().channels.push_back({.name = row.name,
                                          .sender = row.sender,
                                          .receiver = row.receiver,
                                          .has_services = row.crossing < first_command});
        if (!weather.drifts) return;
        for (std::size_t n = 0; n < nodes; ++n) {
            const Duration offset{random_.between(0, 1'000'000'000)};
            run_.set_clock(n, {offset, static_cast<double>(random_.between(-100, 100))});
        }
    }

    history::History& live() {
        EXPECT_TRUE(run_.start());
        for (std::size_t n = 0; n < nodes; ++n) begin(n);
        for (std::size_t n = 0; n < nodes; ++n) {
            if (weather_.omits) run_.end(n).omits_one_in = 20;
            if (weather_.doubles) run_.end(n).doubles_one_in = 10;
        }
        run_.run_for(200ms); // each row was sent
        for (const Time end = run_.now() + 700ms; run_.now() < end;) {
            strike();
            run_.run_for(weather_.crowds ? pause : Duration{random_.between(10'000'000, 50'000'000)});
            for (std::size_t n = 0; n < taker_node; ++n)
                if (run_.is_alive(n)) speak(n);
        }
        for (std::size_t n = 0; n < nodes; ++n) {
            run_.end(n).is_cut = false;
            run_.end(n).omits_one_in = 0;
        }
        for (std::size_t n = 0; n < nodes; ++n)
            if (!run_.is_alive(n)) restart(n);
        run_.run_for(300ms); // everything that waits is answered
        for (std::size_t n = 0; n < nodes; ++n) look(n, Count::waits);
        run_.stop();
        return history();
    }
    [[nodiscard]] Longest longest() {
        longest_.served[0] = witness_.slowest_level;
        for (const history::Served& each : history().served) {
            const auto from = history::find_number(history().emitted, each.number);
            keep(longest_.served[first_event + from->sender], each.at - from->at);
        }
        for (const history::Begun& each : history().begun) {
            const auto from = history::find_number(history().asked, each.number);
            keep(longest_.served[first_command + from->sender], each.at - from->invoked);
        }
        for (const history::Asked& each : history().asked)
            if (each.how == CommandState::done)
                keep(longest_.answered[first_command + each.sender],
                     each.responded - each.invoked -
                         Taker::busy_cycles(each.number) * taker_table.activities[0].period);
        return longest_;
    }

private:
    static constexpr std::size_t nodes = trio.nodes.size();
    struct ChannelRow {
        std::string_view name{};
        std::size_t crossing = 0, sender = 0, receiver = 0;
    };
    static constexpr std::array channels{
        ChannelRow{"events of one", 1, 0, taker_node},   ChannelRow{"events of two", 2, 1, taker_node},
        ChannelRow{"commands of one", 3, 0, taker_node}, ChannelRow{"commands of two", 4, 1, taker_node},
        ChannelRow{"replies to one", 3, taker_node, 0},  ChannelRow{"replies to two", 4, taker_node, 1}};
    enum class Count : std::uint8_t {
        unknown, ///< unanswered calls: their start ends
        waits
    };

    static void keep(Duration& longest, Duration one) { longest = std::max(longest, one); }
    history::History& history() { return witness_.history; }
    Sender& sender(std::size_t n) { return *run_.instance(n).find<Sender>("sender"); }

    void speak(std::size_t n) {
        Sender& to = sender(n);
        if (run_.now() >= may_emit_[n] && (weather_.crowds || random_.one_in(2))) {
            to.to_emit = ++last_event_;
            may_emit_[n] = run_.now() + pause;
        }
        if (run_.now() >= may_ask_[n] && to.adds == 0 && (weather_.crowds || random_.one_in(2))) {
            do to.to_add = static_cast<Number>(random_.between(1, 100'000));
            while (!numbers_.insert(to.to_add).second);
            may_ask_[n] = run_.now() + pause;
        }
    }
    void strike() {
        if (weather_.spoils && run_.now() >= may_spoil_ && random_.one_in(2)) {
            run_.wire().faults.spoil.next = 1;
            may_spoil_ = run_.now() + 2 * trio.wire.errors.every;
        }
        const std::size_t n = random_.below(nodes);
        if (weather_.kills && random_.one_in(run_.is_alive(n) ? 10 : 2))
            run_.is_alive(n) ? end(n) : restart(n);
        const std::size_t c = random_.below(nodes);
        if (weather_.cuts && random_.one_in(run_.end(c).is_cut ? 2 : 10))
            run_.end(c).is_cut = !run_.end(c).is_cut;
    }
    void restart(std::size_t n) {
        ASSERT_TRUE(run_.start(n));
        begin(n);
    }
    void begin(std::size_t n) {
        history().lives[n].push_back({.begins = run_.now()});
        if (n == taker_node) {
            run_.instance(n).find<Taker>("taker")->witness = &witness_;
        } else {
            sender(n).witness = &witness_;
            sender(n).self = n;
        }
    }
    /// Most nodes die without a last message.
    void end(std::size_t n) {
        random_.one_in(4) ? run_.stop(n) : run_.kill(n);
        history().lives[n].back().ends = run_.now();
        look(n, Count::unknown);
    }

    void look(std::size_t n, Count unanswered) {
        const std::array looks{&Story::count_of<0>, &Story::count_of<1>, &Story::count_of<2>};
        for (std::size_t i = 0; i < channels.size(); ++i) {
            const ChannelRow& row = channels[i];
            history::Channel& sum = history().channels[i];
            const auto [sent, received] = (this->*looks[n])(row.crossing);
            if (n == row.receiver) {
                sum.received.served += received.served, sum.received.lost += received.lost;
                sum.received.repeated += received.repeated;
            }
            if (n != row.sender) continue;
            const std::uint64_t open = sent.offered - sent.delivered - sent.lost - sent.unknown;
            sum.sent.offered += sent.offered, sum.sent.delivered += sent.delivered;
            sum.sent.lost += sent.lost, sum.sent.unknown += sent.unknown;
            (unanswered == Count::unknown ? sum.sent.unknown : sum.waiting) += open;
        }
        for (std::size_t f = 0; f < systems::plan_of<trio>.frames.size(); ++f) {
            const WireFrame& frame = systems::plan_of<trio>.frames[f];
            if (frame.node != n) continue;
            const Duration seen = run_.end(n).longest_response({frame.id, false});
            longest_.frames[f] = std::max(longest_.frames[f], to_seconds(seen) / to_seconds(frame.worst));
        }
    }
    template <std::size_t n>
    std::pair<SendCounts, ReceiveCounts> count_of(std::size_t crossing) {
        if (n != taker_node && systems::plan_of<trio>.index[crossing].from.node != n) return {};
        const auto& link = *run_.instance(n).find<systems::Link<trio, n>>("wire");
        return {link.sent(crossing), link.served(crossing)};
    }

    Random random_;
    Weather weather_;
    std::array<AcceptedMachine, nodes> machines_{OneFirmware::machine(), TwoFirmware::machine(),
                                                 TakerFirmware::machine()};
    SystemRun run_;
    Witness witness_{};
    Longest longest_{};
    Number last_event_ = 0;
    std::set<Number> numbers_{};
    std::array<Time, taker_node> may_emit_{}, may_ask_{};
    Time may_spoil_{};
};

} // namespace tappet::trio
