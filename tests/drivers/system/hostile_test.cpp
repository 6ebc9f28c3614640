// Frames of a lying node: with any identifier of the wire and any contents, damaged or with right protection.
#include "tests/drivers/system/pair_run.hpp"

#include <gtest/gtest.h>

namespace tappet::pair {
namespace {

TEST(Hostile, frames_stop_no_node_and_damaged_ones_are_refused) {
    const auto& plan = systems::plan_of<pair>;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        Random random{seed};
        PairRun both{seed};
        SystemRun& run = both.run;
        std::array<can::Identifier, plan.frames.size()> all{};
        for (std::size_t f = 0; f < all.size(); ++f) all[f] = {plan.frames[f].id, false};
        can::Twin liar;
        ASSERT_TRUE(liar.open({.interface = "liar", .transmit = all}));
        ASSERT_TRUE(run.wire().attach(liar));
        both.start();
        std::int64_t damaged = 0;
        for (int n = 0; n < 300; ++n) {
            const WireFrame& as = plan.frames[random.below(plan.frames.size())];
            can::Frame frame{.id = as.id,
                             .length =
                                 random.one_in(20) ? static_cast<std::uint8_t>(random.below(9)) : as.bytes};
            for (std::size_t i = 0; i < 8; ++i) frame.data[i] = static_cast<std::uint8_t>(random.next());
            frame.stamp = run.now() + 1ns;
            const bool is_right = random.one_in(2) && frame.length == as.bytes;
            if (is_right) {
                ASSERT_TRUE(protect(std::span{frame.data}.first(frame.length),
                                    {.form = Protection::Form::id_both, .id = as.data_id},
                                    static_cast<std::uint8_t>(random.below(15))));
            }
            damaged += is_right ? 0 : 1;
            static_cast<void>(liar.send(frame, can::Keep::every));
            liar.service(run.now());
            ASSERT_TRUE(run.run_for(2ms)) << "seed " << seed;
            can::Frame ignored;
            while (liar.receive(ignored).what != can::Received::none) {
            }
        }
        std::int64_t refused = 0;
        refused += run.instance(0).find<systems::Link<pair, 0>>("wire")->frames_refused.last();
        refused += run.instance(1).find<systems::Link<pair, 1>>("wire")->frames_refused.last();
        EXPECT_GT(refused, damaged / 2) << "seed " << seed;
    }
}

} // namespace
} // namespace tappet::pair
