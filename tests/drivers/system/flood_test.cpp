// A full wire disturbs no activity that is more urgent than it: in virtual time, each cycle takes up to its
// budget and the most urgent activity runs. While all nodes keep their rates, the wire's own activity wakes
// at most as often as its row says. When a node exceeds its rate, it wakes more often, and that is reported.
#include "board/host/board.hpp"
#include "kernel/machine/accept.hpp"
#include "tests/drivers/system/flood.hpp"
#include "toolchain/machine/system_run.hpp"

#include <gtest/gtest.h>

namespace tappet::flood {
namespace {

constexpr std::uint32_t bits_per_second = 500'000;
constexpr std::size_t a = 0, b = 1;

/// Source of the frames, which come back to back.
enum class Flood : std::uint8_t { none, of_the_other, of_ours };

struct Seen {
    Duration loop{}, wire{}; ///< the longest responses
    std::uint64_t misses = 0, frames = 0, wire_misses = 0, wakes_too_many = 0;
};

template <const auto& system>
class Flooded {
public:
    Flooded(std::uint64_t seed, std::uint32_t rate) : run_{at_rate(rate), machines_, {}, seed} {
        for (std::size_t node : {a, b}) run_.run(node).take_times(seed + node, {rate, 0});
    }
    void start() {
        for (const WireFrame& frame : plan.frames)
            static_cast<void>(identifiers_.push(can::standard(frame.id)));
        ASSERT_TRUE(
            liar_.open({.interface = "liar", .transmit = {identifiers_.begin(), identifiers_.size()}}));
        ASSERT_TRUE(run_.wire().attach(liar_));
        const auto started = run_.start();
        ASSERT_TRUE(started) << started.error().view();
        ASSERT_TRUE(run_.run_for(300ms));
    }
    /// The longest so far.
    Seen after(Flood flood, Duration time, Random& random) {
        for (const Time end = run_.now() + time; run_.now() < end;) {
            if (flood != Flood::none) fill(flood == Flood::of_ours ? a : b, random);
            EXPECT_TRUE(run_.run_for(50us));
        }
        Seen seen;
        const auto& engines = run_.instance(a).engines();
        for (std::size_t n = 0; n < engines.size(); ++n) {
            const EngineStatistics& has = engines[n].statistics();
            if (engines[n].name() == "loop")
                seen.loop = run_.run(a).world().longest_response(n), seen.misses = has.misses;
            if (engines[n].name() == "wire") {
                seen.wire = run_.run(a).world().longest_response(n);
                seen.wire_misses = has.misses, seen.wakes_too_many = has.wakes_too_many;
            }
        }
        seen.frames = run_.twin(a).counters().received + run_.twin(a).counters().impostors;
        return seen;
    }

private:
    static constexpr auto& plan = systems::plan_of<system>;
    static SystemView at_rate(std::uint32_t rate) {
        SystemView view = system.view();
        view.wire.rate = {rate, 0};
        return view;
    }
    /// Sends as many frames as fit, all frames of the node in turn.
    void fill(std::size_t of, Random& random) {
        liar_.service(run_.now());
        for (can::Frame ignored; liar_.receive(ignored).what != can::Received::none;) {
        }
        for (int tries = 0; tries < 8; ++tries) {
            const WireFrame& as = plan.frames[next_++ % plan.frames.size()];
            if (as.node != of) continue;
            can::Frame frame = frame_of(as, random.next(), static_cast<std::uint8_t>(random.below(15)));
            frame.stamp = run_.now();
            static_cast<void>(liar_.send(frame, can::Keep::every));
        }
        liar_.service(run_.now());
    }

    std::array<AcceptedMachine, 2> machines_{AtRunTime<station<system, "a", table>, board::host>::machine(),
                                             AtRunTime<station<system, "b", table>, board::host>::machine()};
    SystemRun run_;
    Bounded<can::Identifier, plan.frames.size()> identifiers_{};
    can::Twin liar_{};
    std::size_t next_ = 0;
};

template <const auto& system>
std::pair<Seen, Seen> quiet_and_flooded(Flood flood, std::uint64_t seed, std::uint32_t rate) {
    Random random{seed};
    Flooded<system> two{seed, rate};
    two.start();
    const Seen quiet = two.after(Flood::none, 500ms, random);
    return {quiet, two.after(flood, 500ms, random)};
}

class UnderFlood : public testing::TestWithParam<Flood> {};
INSTANTIATE_TEST_SUITE_P(Floods, UnderFlood, testing::Values(Flood::of_the_other, Flood::of_ours));

TEST_P(UnderFlood, an_activity_more_urgent_than_the_wire_keeps_its_response) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const auto [quiet, flooded] = quiet_and_flooded<right>(GetParam(), seed, bits_per_second);
        EXPECT_EQ(quiet.loop, loop_budget) << "seed " << seed;
        EXPECT_EQ(flooded.loop, loop_budget) << "seed " << seed;
        EXPECT_EQ(flooded.misses, 0u) << "seed " << seed;
        if (GetParam() == Flood::of_the_other) {
            EXPECT_GT(flooded.frames - quiet.frames, 1500u) << "a full wire carries some 2000 in this time";
        }
    }
}

TEST_P(UnderFlood, the_activity_of_the_wire_meets_its_deadline) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const auto [quiet, flooded] = quiet_and_flooded<right>(GetParam(), seed, bits_per_second);
        EXPECT_LE(flooded.wire, 1ms) << "seed " << seed;
        EXPECT_EQ(flooded.wire_misses, 0u) << "seed " << seed;
        EXPECT_EQ(quiet.wakes_too_many, 0u) << "seed " << seed << ": all keep their rates";
        if (GetParam() == Flood::of_ours) {
            EXPECT_EQ(flooded.wakes_too_many, 0u) << "seed " << seed << ": nobody here wants them";
        }
    }
}

TEST_P(UnderFlood, a_wire_more_urgent_than_the_loop_disturbs_it) {
    const auto [quiet, flooded] = quiet_and_flooded<wrong>(GetParam(), 1, bits_per_second);
    EXPECT_GT(flooded.loop, loop_budget) << "what the other cases look for is found where it is planted";
}

TEST(FloodBeyondTheRate, is_reported_and_disturbs_no_other_activity) {
    const auto [quiet, flooded] = quiet_and_flooded<right>(Flood::of_the_other, 1, 16 * bits_per_second);
    EXPECT_EQ(quiet.wakes_too_many, 0u);
    EXPECT_GT(flooded.wakes_too_many, 0u);
    EXPECT_EQ(flooded.loop, loop_budget);
    EXPECT_EQ(flooded.misses, 0u);
}

} // namespace
} // namespace tappet::flood
