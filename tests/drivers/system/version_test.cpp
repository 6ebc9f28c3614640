// A node of another version of the system: equal rows work there, different ones are refused by name.
#include "tests/drivers/system/pair_run.hpp"

#include <gtest/gtest.h>

namespace tappet::pair {
namespace {

// clang-format off
/// The value has finer steps.
inline constexpr auto newer_pair = system("pair",
    both_nodes, usual_wire("wire"),
    crossings(
        across(data("a.giver.level", "b.taker.level", stale_after(60ms), hold), every(10ms), in_bits(24, 0.01)),
        sent_row, doubled_row, b_row, a_row));
// clang-format on
using NewerTaker = AtRunTime<station<newer_pair, "b", taker_table>, board::host>;

TEST(Versions, exchange_equal_rows_and_refuse_different_ones_by_name) {
    PairRun<GiverFirmware, NewerTaker> both;
    both.start(0ms);
    SystemRun& run = both.run;
    Giver& giver = both.giver();
    Taker& taker = both.taker();
    auto& from = *run.instance(0).find<systems::Link<pair, 0>>("wire");
    auto& to = *run.instance(1).find<systems::Link<newer_pair, 1>>("wire");
    ASSERT_TRUE(
        run.run_until([&] { return giver.other_is_there.get() && taker.other_is_there.get(); }, 500ms));
    giver.tells = 5.0;
    giver.to_send = {1, 2, 3};
    giver.asks = 4;
    run.run_for(400ms);
    EXPECT_EQ(taker.got, (std::vector<std::int32_t>{1, 2, 3}));
    EXPECT_EQ(giver.doubled.state(), CommandState::done);
    EXPECT_EQ(giver.doubled.result<0>(), 8);
    EXPECT_EQ(taker.level.flow(), Flow::never_written);
    constexpr std::string_view refusal =
        "has another row \"a.giver.level\" -> \"b.taker.level\": give both one version of the system";
    EXPECT_EQ(to.refused.last().view(), "node \"a\" " + std::string{refusal});
    EXPECT_EQ(from.refused.last().view(), "node \"b\" " + std::string{refusal});
    EXPECT_FALSE(to.works(0));
    EXPECT_TRUE(to.works(1));
}

TEST(Versions, connect_once_the_right_version_starts) {
    PairRun both;
    both.start();
    SystemRun& run = both.run;
    run.stop(1); // orderly: it announces its end
    run.run_for(20ms);
    EXPECT_FALSE(both.giver().other_is_there.get()) << "before its silence would tell";
    ASSERT_TRUE(run.start(1));
    run.run_for(300ms);
    EXPECT_TRUE(both.taker().level.good());
    EXPECT_EQ((run.instance(1).find<systems::Link<pair, 1>>("wire")->refused.last().view()), "");
}

} // namespace
} // namespace tappet::pair
