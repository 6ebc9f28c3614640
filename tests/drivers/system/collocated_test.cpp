// The same system with and without its wire: its components behave and receive the same.
#include "kernel/machine/accept.hpp"
#include "kernel/system/collocated.hpp"
#include "tests/drivers/system/pair_run.hpp"

#include <gtest/gtest.h>

namespace tappet::pair {
namespace {

inline constexpr auto in_one_box = collocated<pair, giver_table, taker_table>;
using LocalFirmware = AtRunTime<in_one_box, board::host>;

struct NoPlant final : Plant {
    Time move(Time) override { return never; }
};

/// The actions and observations of the two components.
struct Seen {
    std::vector<std::int32_t> got{};
    std::vector<double> levels{};
    std::vector<std::int32_t> answers{};
    bool is_there = false;
    bool operator==(const Seen&) const = default;
};

/// Runs the same story, whatever moves the time.
template <class RunFor>
Seen tell(Giver& giver, Taker& taker, RunFor run_for) {
    Seen seen;
    run_for(400ms);
    for (int i = 1; i <= 25; ++i) {
        giver.tells = i * 0.5;
        giver.to_send.push_back(i * i);
        if (i % 3 == 0) giver.asks = i;
        taker.busy_for = i % 4;
        run_for(150ms);
        seen.levels.push_back(taker.level.get());
        if (i % 3 == 0 && giver.doubled.state() == CommandState::done)
            seen.answers.push_back(giver.doubled.result<0>());
    }
    seen.got = taker.got;
    seen.is_there = giver.other_is_there.get() && taker.other_is_there.get();
    return seen;
}

TEST(Collocated, components_behave_alike_with_and_without_a_wire) {
    NoPlant none;
    VirtualRun local{LocalFirmware::machine(), none, 1};
    ASSERT_TRUE(local.start());
    const Seen in_one = tell(*local.instance().find<Giver>("giver"), *local.instance().find<Taker>("taker"),
                             [&](Duration time) { local.run_for(time); });
    local.stop();

    PairRun cut;
    cut.start(0ms);
    const Seen in_two = tell(cut.giver(), cut.taker(), [&](Duration time) { cut.run.run_for(time); });

    EXPECT_EQ(in_one.got.size(), 25u);
    EXPECT_EQ(in_one.answers, (std::vector<std::int32_t>{6, 12, 18, 24, 30, 36, 42, 48}));
    EXPECT_TRUE(in_one == in_two);
}

} // namespace
} // namespace tappet::pair
