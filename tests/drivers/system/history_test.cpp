// A thousand seeds of what goes wrong on a wire and at its ends: whatever happens, no event is served twice
// or out of order, every loss is known, a command that is done was done once, and what is heard came in the
// time that was proven.
#include "tests/drivers/system/pair.hpp"
#include "toolchain/machine/system_run.hpp"

#include <gtest/gtest.h>

#include <map>

namespace tappet::pair {
namespace {

/// What a run may meet.
struct Faults {
    bool omits = false, doubles = false, spoils = false, kills = false, cuts = false, drifts = true;
};

/// What the two ends say in the end, and what was seen on the way.
struct History {
    std::vector<std::int32_t> emitted{};
    std::vector<std::vector<std::int32_t>> served{}; ///< by each start of the taker
    std::map<std::int32_t, Time> emitted_at{};
    Duration slowest{};
    SendCounts sent{};        ///< of all starts of the giver
    ReceiveCounts received{}; ///< of all starts of the taker's node
    std::int64_t losses_told = 0;
    std::int64_t answered = 0, wrong_answers = 0;
    double nearest = 0; ///< observed by proven, of the frames
};

class Story {
public:
    Story(std::uint64_t seed, const Faults& faults)
        : random_{seed}, faults_{faults}, run_{pair.view(), machines_, {}, seed} {
        if (faults.drifts)
            for (std::size_t n = 0; n < 2; ++n)
                run_.set_clock(n, {Duration{random_.between(0, 1'000'000'000)},
                                   static_cast<double>(random_.between(-100, 100))});
    }
    History live() {
        EXPECT_TRUE(run_.start());
        begin_taker();
        if (faults_.omits) run_.end(0).omits_one_in = run_.end(1).omits_one_in = 20;
        if (faults_.doubles) run_.end(0).doubles_one_in = run_.end(1).doubles_one_in = 10;
        if (faults_.spoils) run_.wire().faults.spoil.one_in = 50;
        for (int step = 0; step < 60; ++step) {
            strike();
            run_.run_for(Duration{random_.between(5'000'000, 60'000'000)});
            watch();
            if (run_.is_alive(0) && random_.one_in(2) && giver().to_send.empty()) emit();
            if (run_.is_alive(0) && random_.one_in(4)) ask();
        }
        for (std::size_t n = 0; n < 2; ++n) {
            run_.end(n).is_cut = false;
            run_.end(n).omits_one_in = 0;
            if (!run_.is_alive(n)) restart(n);
        }
        run_.run_for(1s);
        watch();
        end_giver();
        end_taker();
        for (std::size_t n = 0; n < 2; ++n) look_at_wire(n);
        run_.stop();
        return history_;
    }

private:
    Giver& giver() { return *run_.instance(0).find<Giver>("giver"); }
    Taker& taker() { return *run_.instance(1).find<Taker>("taker"); }
    systems::Link<pair, 0>& from() { return *run_.instance(0).find<systems::Link<pair, 0>>("wire"); }
    systems::Link<pair, 1>& to() { return *run_.instance(1).find<systems::Link<pair, 1>>("wire"); }

    void emit() {
        const auto number = static_cast<std::int32_t>(history_.emitted.size() + 1);
        history_.emitted.push_back(number);
        history_.emitted_at[number] = run_.now() + 5ms; // in the giver's next cycle, at the latest
        giver().to_send.push_back(number);
    }
    void ask() {
        if (asked_ != 0 || in_flight(giver().doubled.state())) return;
        asked_ = static_cast<std::int32_t>(random_.between(1, 1000));
        giver().asks = asked_;
    }
    void strike() {
        if (faults_.kills && random_.one_in(8)) {
            const std::size_t n = random_.one_in(2) ? 0 : 1;
            if (run_.is_alive(n)) {
                if (n == 0) end_giver();
                if (n == 1) end_taker();
                run_.kill(n);
            } else {
                restart(n);
            }
        }
        if (faults_.cuts && random_.one_in(8)) {
            WireEnd& end = run_.end(random_.one_in(2) ? 0 : 1);
            end.is_cut = !end.is_cut;
        }
    }
    void restart(std::size_t n) {
        ASSERT_TRUE(run_.start(n));
        if (n == 1) begin_taker();
        if (n == 0) asked_ = 0;
    }
    void begin_taker() { history_.served.emplace_back(), seen_ = 0; }
    void end_giver() {
        const SendCounts& count = from().sent(1);
        history_.sent.offered += count.offered, history_.sent.delivered += count.delivered;
        history_.sent.lost += count.lost,
            history_.sent.unknown +=
            count.unknown + count.offered - count.delivered - count.lost - count.unknown;
        history_.losses_told += giver().losses;
    }
    void end_taker() {
        watch();
        const ReceiveCounts& count = to().served(1);
        history_.received.served += count.served, history_.received.lost += count.lost;
        history_.received.repeated += count.repeated;
    }
    void watch() {
        if (run_.is_alive(1)) {
            const auto& got = taker().got;
            for (; seen_ < got.size(); ++seen_) history_.served.back().push_back(got[seen_]);
        }
        if (!run_.is_alive(0) || asked_ == 0 || giver().asks != 0) return;
        const CommandState state = giver().doubled.state();
        if (in_flight(state)) return;
        if (state == CommandState::done) {
            ++history_.answered;
            if (giver().doubled.result<0>() != 2 * asked_) ++history_.wrong_answers;
        }
        asked_ = 0;
    }
    void look_at_wire(std::size_t n) {
        for (const WireFrame& frame : systems::plan_of<pair>.frames) {
            if (frame.node != n) continue;
            const Duration seen = run_.end(n).longest_response({frame.id, false});
            history_.nearest = std::max(history_.nearest, to_seconds(seen) / to_seconds(frame.worst));
        }
    }

    Random random_;
    Faults faults_;
    std::array<AcceptedMachine, 2> machines_{GiverFirmware::machine(), TakerFirmware::machine()};
    SystemRun run_;
    History history_{};
    std::size_t seen_ = 0;
    std::int32_t asked_ = 0;
};

/// Never twice and in order, over all starts of the taker.
testing::AssertionResult is_in_order(const History& history) {
    std::int32_t last = 0;
    for (const auto& part : history.served)
        for (const std::int32_t number : part) {
            if (number <= last) return testing::AssertionFailure() << number << " was served after " << last;
            last = number;
        }
    return testing::AssertionSuccess();
}

std::uint64_t served_in_all(const History& history) {
    std::uint64_t count = 0;
    for (const auto& part : history.served) count += part.size();
    return count;
}

TEST(History, without_faults_everything_is_served) {
    const History history = Story{1, {.drifts = false}}.live();
    EXPECT_TRUE(is_in_order(history));
    EXPECT_EQ(history.sent.delivered, history.sent.offered);
    EXPECT_EQ(served_in_all(history), history.sent.offered);
    EXPECT_GT(history.answered, 3);
}

TEST(History, omitted_doubled_and_spoilt_frames_cost_no_order_and_every_loss_is_counted_at_both_ends) {
    std::uint64_t lost = 0, repeated = 0;
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        const History history = Story{seed, {.omits = true, .doubles = true, .spoils = true}}.live();
        ASSERT_TRUE(is_in_order(history)) << "seed " << seed;
        ASSERT_EQ(history.sent.offered, history.sent.delivered + history.sent.lost + history.sent.unknown)
            << seed;
        ASSERT_EQ(history.wrong_answers, 0) << seed;
        if (history.sent.unknown == 0) {
            ASSERT_EQ(served_in_all(history), history.sent.delivered) << "seed " << seed;
            ASSERT_EQ(history.received.lost, history.sent.lost) << "seed " << seed;
        }
        ASSERT_LE(history.nearest, 1.0) << "seed " << seed;
        lost += history.sent.lost, repeated += history.received.repeated;
    }
    EXPECT_GT(lost, 0u) << "the faults strike";
    EXPECT_GT(repeated, 100u);
}

TEST(History, killed_restarted_and_cut_nodes_serve_nothing_twice) {
    std::uint64_t unknown = 0, served = 0;
    for (std::uint64_t seed = 1; seed <= 700; ++seed) {
        const History history =
            Story{seed, {.omits = true, .doubles = true, .spoils = true, .kills = true, .cuts = true}}.live();
        ASSERT_TRUE(is_in_order(history)) << "seed " << seed;
        ASSERT_EQ(history.wrong_answers, 0) << seed;
        // What was neither answered nor known to be lost is what a start of a node took with it.
        ASSERT_LE(history.received.served, history.sent.delivered + history.sent.unknown) << "seed " << seed;
        ASSERT_GE(history.received.served, history.sent.delivered) << "seed " << seed;
        // A node that is killed takes with it what waits in a mailbox of its own.
        ASSERT_LE(served_in_all(history), history.received.served) << "seed " << seed;
        ASSERT_LE(history.nearest, 1.0) << "seed " << seed;
        unknown += history.sent.unknown, served += served_in_all(history);
    }
    EXPECT_GT(unknown, 0u);
    EXPECT_GT(served, 1000u);
}

} // namespace
} // namespace tappet::pair
