// The lane as a whole: each board gets the work that it asks for, whatever the wire does; a silent node stops
// the belt within the proven time.
#include "apps/woodworking_lane/host/lane_run.hpp"
#include "apps/woodworking_lane/lane.hpp"

#include <gtest/gtest.h>

namespace woodworking {
namespace {

/// Clocks that differ and drift.
void set_clocks(LaneRun& run, Random& random) {
    for (std::size_t n = 0; n < node_count; ++n)
        run.system.set_clock(
            n, {Duration{random.between(0, 1'000'000'000)}, static_cast<double>(random.between(-100, 100))});
}

TEST(Lane, works_on_every_board_as_its_programme_says) {
    for (std::uint64_t seed = 1; seed <= SEEDS; ++seed) {
        Random random{seed};
        LaneRun run{seed, 8};
        set_clocks(run, random);
        ASSERT_TRUE(run.start());
        EXPECT_TRUE(run.run_through(300s)) << "seed " << seed;
        int missed = 0;
        EXPECT_EQ(fault_of(run.hall, missed).view(), "") << "seed " << seed;
        EXPECT_EQ(missed, 0) << "seed " << seed;
        run.system.stop();
    }
}

TEST(Lane, works_on_every_board_despite_corrupt_lost_and_repeated_frames) {
    for (std::uint64_t seed = 1; seed <= SEEDS; ++seed) {
        Random random{seed};
        LaneRun run{seed, 8};
        set_clocks(run, random);
        run.system.wire().faults.spoil.one_in = 100;
        for (std::size_t n = 0; n < node_count; ++n)
            run.system.end(n).omits_one_in = 300, run.system.end(n).doubles_one_in = 50;
        ASSERT_TRUE(run.start());
        run.run_through(300s);
        int missed = 0;
        EXPECT_EQ(fault_of(run.hall, missed).view(), "") << "seed " << seed;
        run.system.stop();
    }
}

TEST(Lane, is_the_same_for_the_same_seed) {
    const auto digest = [] {
        Random random{7};
        LaneRun run{7, 3};
        set_clocks(run, random);
        EXPECT_TRUE(run.start());
        run.run_for(60s);
        const std::uint64_t all = run.system.digest();
        run.system.stop();
        return all;
    };
    EXPECT_EQ(digest(), digest());
}

/// Time from a node's death until the belt is told to stop.
Duration stop_time(std::uint64_t seed) {
    Random random{seed};
    LaneRun run{seed, 4};
    set_clocks(run, random);
    EXPECT_TRUE(run.start());
    run.run_for(3s + Duration{random.between(0, 20'000'000)});
    EXPECT_TRUE(run.hall.runs) << "seed " << seed;
    const Time died = run.system.now();
    run.kill(1 + random.below(station_count));
    Duration took = never - died;
    run.system.judge_by([&](Time now) {
        if (!run.hall.runs) took = std::min(took, now - died);
    });
    run.system.run_for(200ms);
    run.system.stop();
    return took;
}

TEST(Lane, stops_within_the_proven_time_when_a_node_dies) {
    const auto& promised = systems::promises_of<lane>.proven;
    const Duration proven = *std::max_element(promised.begin() + 2, promised.end());
    Duration longest{};
    for (std::uint64_t seed = 1; seed <= KILLS; ++seed) {
        const Duration took = stop_time(seed);
        ASSERT_LE(took, proven) << "seed " << seed;
        longest = std::max(longest, took);
    }
    RecordProperty("longest_us", static_cast<int>(longest.count() / 1000));
    RecordProperty("proven_us", static_cast<int>(proven.count() / 1000));
    EXPECT_GE(to_seconds(longest), 0.7 * to_seconds(proven)) << longest.count();
}

TEST(Lane, continues_once_a_dead_node_is_back_and_acknowledged) {
    LaneRun run{3, 8};
    ASSERT_TRUE(run.start());
    run.run_for(30s);
    run.kill(2);
    run.run_for(1s);
    EXPECT_FALSE(run.hall.runs);
    EXPECT_EQ(run.hall.speed, 0.0);
    ASSERT_TRUE(run.system.start(2));
    run.run_for(1s);
    EXPECT_FALSE(run.hall.runs) << "nothing moves before an acknowledgement";
    run.acknowledge();
    EXPECT_TRUE(run.hall.runs);
    EXPECT_TRUE(run.run_through(400s));
    int missed = 0;
    EXPECT_EQ(fault_of(run.hall, missed).view(), "");
    run.system.stop();
}

TEST(Lane, outlives_a_babbling_node_and_ignores_its_frames) {
    LaneRun run{5, 4};
    ASSERT_TRUE(run.start());
    run.run_for(5s);
    can::Frame frame;
    frame.id = 0x7FF;
    frame.length = 8;
    run.system.wire().babble(frame, 1ms, run.system.now());
    run.run_for(20s);
    EXPECT_TRUE(run.hall.runs);
    int missed = 0;
    EXPECT_EQ(fault_of(run.hall, missed).view(), "");
    // A frame in the name of another node: its protection does not fit.
    frame.id = systems::plan_of<lane>.frames[systems::NodeRows<lane, 1>::beat_frame].id;
    run.system.wire().babble(frame, 3ms, run.system.now());
    run.run_for(1s);
    const auto* end = run.system.instance(0).find<systems::Link<lane, 0>>("lane");
    EXPECT_GT(end->frames_refused.last(), 100);
    EXPECT_TRUE(run.hall.runs);
    run.system.stop();
}

TEST(Lane, delivers_every_frame_within_its_proven_time) {
    double nearest = 0;
    for (std::uint64_t seed = 1; seed <= SEEDS; ++seed) {
        LaneRun run{seed, 6};
        run.system.wire().faults.spoil.one_in = 200;
        ASSERT_TRUE(run.start());
        run.run_for(60s);
        for (const WireFrame& frame : systems::plan_of<lane>.frames) {
            const Duration seen = run.system.end(frame.node).longest_response({frame.id, false});
            EXPECT_LE(seen, frame.worst) << "frame " << frame.id;
            nearest = std::max(nearest, to_seconds(seen) / to_seconds(frame.worst));
        }
        run.system.stop();
    }
    RecordProperty("nearest_per_mille", static_cast<int>(nearest * 1000));
}

TEST(Lane, draws_its_boards) {
    LaneRun run{1, 2};
    ASSERT_TRUE(run.start());
    run.run_for(30s);
    const std::string picture = picture_of(run);
    EXPECT_NE(picture.find("polyline"), std::string::npos);
    EXPECT_NE(picture.find("</svg>"), std::string::npos);
    run.system.stop();
}

} // namespace
} // namespace woodworking
