// A thousand seeds of faults on a wire and at its ends: the recorded history passes every checker, and
// arrivals stay within the proven time, and come near it.
#include "tests/drivers/system/story.hpp"

#include <cstdio>

namespace tappet::trio {
namespace {

constexpr auto& plan = systems::plan_of<trio>;

/// Cases met over many seeds: a checker without cases finds nothing.
struct Met {
    std::uint64_t emitted = 0, served = 0, told = 0, asked = 0, done = 0, refused = 0;
    std::uint64_t lost = 0, unknown = 0, repeated = 0; ///< messages, of all channels
    std::uint64_t overlapping = 0; ///< done while a command of the other sender was in flight
    std::uint64_t failed_but_executed = 0, failed_and_not = 0;
    Longest longest{};

    void add(Story& story, const history::History& history) {
        longest.merge(story.longest());
        emitted += history.emitted.size(), served += history.served.size();
        told += history.told.size(), asked += history.asked.size();
        for (const history::Channel& each : history.channels) {
            lost += each.sent.lost, unknown += each.sent.unknown, repeated += each.received.repeated;
        }
        for (const history::Begun& each : history.begun) refused += each.is_refused ? 1u : 0u;
        for (const history::Asked& each : history.asked) add(each, history);
    }
    void add(const history::Asked& one, const history::History& history) {
        const bool was_executed =
            history::find_number(history.executed, one.number) != history.executed.end();
        if (one.how != CommandState::done) {
            ++(was_executed ? failed_but_executed : failed_and_not);
            return;
        }
        ++done;
        for (const history::Asked& other : history.asked)
            if (other.sender != one.sender && other.how == CommandState::done &&
                other.invoked < one.responded && one.invoked < other.responded) {
                ++overlapping;
                return;
            }
    }
};

/// Stops at the first seed with a wrong history.
void live(std::uint64_t seeds, const Weather& weather, Met& met) {
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        Story story{seed, weather};
        const history::History& history = story.live();
        ASSERT_EQ(history::faults_of(history), std::vector<std::string>{}) << "seed " << seed;
        met.add(story, history);
    }
}

/// Observed divided by proven response of each frame on the wire. Returns the nearest.
double expect_frames_in_time(const Longest& longest) {
    double nearest = 0;
    for (std::size_t f = 0; f < plan.frames.size(); ++f) {
        EXPECT_LE(longest.frames[f], 1.0) << "frame " << plan.frames[f].id;
        nearest = std::max(nearest, longest.frames[f]);
    }
    std::printf("frames, nearest %.2f\n", nearest);
    return nearest;
}

/// Time from the end of a command until its sender sees it.
Duration proven_back(std::size_t crossing) {
    return plan.frames[plan.place[crossing].reply].worst + trio.wire.service.deadline + Story::reader;
}

/// The same for each row, from component to component.
double expect_rows_in_time(const Longest& longest) {
    double nearest = 0;
    const auto compare = [&](std::size_t x, const char* what, Duration seen, Duration proven) {
        const double part = to_seconds(seen) / to_seconds(proven);
        std::printf("%-6s %-16s %6.3f ms of %6.3f ms, %.2f\n", what,
                    std::string{trio.crossings[x].from()}.c_str(), 1e3 * to_seconds(seen),
                    1e3 * to_seconds(proven), part);
        EXPECT_GT(part, 0.0) << trio.crossings[x].from();
        EXPECT_LE(part, 1.0) << trio.crossings[x].from();
        nearest = std::max(nearest, part);
    };
    for (std::size_t x = 0; x < row_count; ++x) {
        const Duration proven = systems::promises_of<trio>.proven[x]; // each row has a promise
        compare(x, "there", longest.served[x], proven);
        if (trio.crossings[x].kind == CrossingKind::command)
            compare(x, "back", longest.answered[x], proven + proven_back(x));
    }
    return nearest;
}

TEST(History, delivers_everything_without_faults) {
    Met met;
    ASSERT_NO_FATAL_FAILURE(live(1, Weather{.drifts = false, .spoils = false}, met));
    EXPECT_GT(met.emitted, 10u);
    EXPECT_EQ(met.served, met.emitted);
    EXPECT_EQ(met.told, 0u);
    EXPECT_GT(met.done, 10u);
    EXPECT_EQ(met.done + met.refused, met.asked);
}

TEST(History, keeps_the_proven_bounds_and_comes_near_them) {
    Met met;
    ASSERT_NO_FATAL_FAILURE(live(200, Weather{.crowds = true}, met));
    EXPECT_EQ(met.lost + met.unknown, 0u);
    EXPECT_GT(met.overlapping, met.done / 2) << "commands of both senders at one time";
    const double of_rows = expect_rows_in_time(met.longest);
    const double of_frames = expect_frames_in_time(met.longest);
    EXPECT_GE(of_rows, 0.7) << "a bound that nothing comes near to shows little";
    EXPECT_GE(of_frames, 0.5);
}

TEST(History, keeps_its_order_and_reports_every_loss_despite_faulty_frames) {
    Met met;
    ASSERT_NO_FATAL_FAILURE(live(300, Weather{.omits = true, .doubles = true, .crowds = true}, met));
    EXPECT_GT(met.lost, 50u) << "the faults strike";
    EXPECT_GT(met.repeated, 1000u);
    EXPECT_EQ(met.unknown, 0u);
    EXPECT_GT(met.told, met.emitted - met.served);
    EXPECT_GT(met.failed_but_executed, 20u);
    EXPECT_GT(met.failed_and_not, 20u);
    EXPECT_GE(expect_frames_in_time(met.longest), 0.7);
}

TEST(History, delivers_nothing_twice_despite_killed_and_disconnected_nodes) {
    Met met;
    ASSERT_NO_FATAL_FAILURE(
        live(500, Weather{.omits = true, .doubles = true, .kills = true, .cuts = true}, met));
    EXPECT_GT(met.unknown, 100u);
    EXPECT_GT(met.served, 1000u);
    EXPECT_GT(met.done, 1000u);
    EXPECT_GT(met.overlapping, 100u);
    EXPECT_GT(met.failed_but_executed, 20u);
    expect_frames_in_time(met.longest);
}

} // namespace
} // namespace tappet::trio
