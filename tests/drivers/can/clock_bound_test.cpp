// A clock sent over a bus, over a thousand seeds: clocks drift, stamps are late, frames wait, are lost and
// come twice, masters restart with another time. The received clock is never further from the truth than its
// stated error.
#include "kernel/machine/accept.hpp"
#include "tests/drivers/can/clock_machines.hpp"
#include "toolchain/machine/system_run.hpp"

#include <gtest/gtest.h>

namespace tappet::test {
namespace {

constexpr Duration late = 100us; // as the properties of the clock have it

constexpr std::array nodes{SystemNode{"teller", {}}, SystemNode{"told", {}}};
constexpr SystemView bus{.name = "clock",
                         .nodes = nodes,
                         .wire = {.name = "wire", .rate = {500'000}},
                         .crossings = {},
                         .promises = {}};

struct Judgement {
    std::int64_t looks = 0, rates = 0, exchanges = 0, discarded = 0, broken = 0, restarts = 0;
    double nearest = 0; ///< error, relative to its bound
    Duration worst_error{};
};

class Story {
public:
    Story(const AcceptedMachine& told, std::uint64_t seed)
        : random_{seed},
          machines_{AtRunTime<telling_machine, board>::machine(), told},
          run_{bus, machines_, {}, seed} {
        for (ClockFault& clock : clocks_) {
            clock.drift_ppm = static_cast<double>(random_.between(-100, 100));
            clock.offset = Duration{random_.between(0, 5'000'000'000)};
        }
        for (std::size_t n = 0; n < 2; ++n) {
            run_.set_clock(n, clocks_[n]);
            run_.end(n).stamps_late = late;
        }
    }
    void live(Judgement& found) {
        // Either may be late by up to a fifth of a second.
        const std::size_t first = random_.below(2);
        begin(first);
        run_.run_for(Duration{random_.between(0, 200'000'000)});
        begin(1 - first);
        run_.end(1).omits_one_in = random_.one_in(2) ? 8 : 0;
        run_.end(1).doubles_one_in = random_.one_in(2) ? 8 : 0;
        run_.wire().faults.spoil.one_in = random_.one_in(2) ? 10 : 0;
        if (random_.one_in(2)) {
            can::Frame urgent{.id = 1, .length = 8};
            run_.wire().babble(urgent, Duration{random_.between(300'000, 2'000'000)}, run_.now());
        }
        for (int part = 0; part < 6; ++part) {
            run_.run_for(Duration{random_.between(50'000'000, 600'000'000)});
            judge(found);
            if (!random_.one_in(3)) continue;
            run_.kill(0);
            run_.run_for(Duration{random_.between(0, 1'500'000'000)});
            judge(found); // by the clock before the restart
            // The next process of the master counts from another time.
            clocks_[0].offset += Duration{random_.one_in(2) ? random_.between(0, 300'000)
                                                            : random_.between(0, 100'000'000'000)};
            run_.set_clock(0, clocks_[0]);
            begin(0);
            exchanges_before_ = told().exchanges.last();
            ++found.restarts;
            has_restarted_ = true;
        }
        judge_rate(found);
        found.exchanges += told().exchanges.last();
        found.discarded += told().discarded.last();
        run_.stop();
    }

private:
    Told& told() { return *run_.instance(1).find<Told>("clock"); }

    void begin(std::size_t node) {
        const auto started = run_.start(node);
        ASSERT_TRUE(started) << started.error().view();
    }
    void judge(Judgement& found) {
        auto& seen = run_.instance(1).find<ClockWatcher>("watcher")->seen;
        for (const ClockWatcher::Seen& each : seen) {
            if (each.exchanges <= exchanges_before_) continue; // no exchange since the master's start
            const Time then = clocks_[1].true_time(each.now);
            const Duration truth = clocks_[0].local(then) - clocks_[1].local(then);
            const std::int64_t wrong = std::abs((each.ahead - truth).count());
            ++found.looks;
            if (wrong > each.error.count() + 2) ++found.broken; // the simulated clocks count whole ns
            found.nearest =
                std::max(found.nearest, static_cast<double>(wrong) / to_seconds(each.error) * 1e-9);
            found.worst_error = std::max(found.worst_error, each.error);
        }
        seen.clear();
    }

    /// For a master that never restarted: both clocks run evenly.
    void judge_rate(Judgement& found) {
        if (has_restarted_ || told().rate_error.last() == 0) return;
        const double truth = (1.0 + clocks_[0].drift_ppm * 1e-6) / (1.0 + clocks_[1].drift_ppm * 1e-6) - 1.0;
        ++found.rates;
        if (std::abs(told().rate.last() - truth) > told().rate_error.last()) ++found.broken;
    }

    Random random_;
    std::array<AcceptedMachine, 2> machines_;
    std::array<ClockFault, 2> clocks_{};
    SystemRun run_;
    std::int64_t exchanges_before_ = 0;
    bool has_restarted_ = false;
};

Judgement judge(const AcceptedMachine& told, std::uint64_t seeds) {
    Judgement found;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) Story{told, seed}.live(found);
    return found;
}

TEST(ClockBound, holds_over_a_thousand_seeds) {
    const Judgement found = judge(AtRunTime<told_machine, board>::machine(), 1000);
    std::printf("%ld looks, %ld exchanges, %ld discarded, %ld restarts, nearest %.3f, worst error %.1f us\n",
                found.looks, found.exchanges, found.discarded, found.restarts, found.nearest,
                to_seconds(found.worst_error) * 1e6);
    EXPECT_EQ(found.broken, 0);
    EXPECT_GT(found.rates, 50);
    EXPECT_GT(found.exchanges, 10'000);
    EXPECT_GT(found.discarded, 1'000) << "the faults strike";
    EXPECT_GT(found.restarts, 500);
    EXPECT_GT(found.nearest, 0.7);
    EXPECT_LT(found.nearest, 1.001);
}

// Every part of the bound is needed.
TEST(ClockBound, fails_without_drift_and_without_either_stamp) {
    EXPECT_GT(judge(AtRunTime<told_without_drift, board>::machine(), 100).broken, 0);
    EXPECT_GT(judge(AtRunTime<told_without_own_late, board>::machine(), 100).broken, 0);
    EXPECT_GT(judge(AtRunTime<told_without_teller_late, board>::machine(), 100).broken, 0);
}

// The SYNC of one start of the master and the FUP of the next start with the same number do not belong
// together.
TEST(ClockTeller, is_not_confused_with_its_previous_start) {
    const std::array machines{AtRunTime<telling_machine, board>::machine(),
                              AtRunTime<told_machine, board>::machine()};
    SystemRun run{bus, machines, {}, 1};
    ASSERT_TRUE(run.start());
    while (run.wire().next() == never && run.now() < Time{1s}) run.run_for(100us); // its first SYNC leaves
    run.kill(0);
    run.run_for(300us);
    ASSERT_EQ(run.wire().frames_on_wire(), 1u);
    run.set_clock(0, {.offset = 10s});
    ASSERT_TRUE(run.start(0));
    auto& watcher = *run.instance(1).find<ClockWatcher>("watcher");
    for (int i = 0; i < 2000; ++i) { // whenever the next SYNC comes, only frames after it arrive
        const std::uint64_t frames = run.wire().frames_on_wire();
        run.end(1).omits_one_in = frames < 2 ? 1 : 0;
        run.run_for(100us);
    }
    ASSERT_GE(run.wire().frames_on_wire(), 3u);
    for (const ClockWatcher::Seen& each : watcher.seen)
        if (each.exchanges > 0) {
            ASSERT_LE(std::abs((each.ahead - 10s).count()), each.error.count() + 2);
        }
    run.run_for(500ms);
    EXPECT_LE(std::abs((watcher.seen.back().ahead - 10s).count()), watcher.seen.back().error.count() + 2);
    EXPECT_GT(watcher.seen.back().exchanges, 0);
    run.stop();
}

} // namespace
} // namespace tappet::test
