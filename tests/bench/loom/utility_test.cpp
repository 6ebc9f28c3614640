// The climate and lubrication unit goes away for ten seconds: the loom weaves on with the last oil pressure it heard of.
#include "tests/bench/loom/loom_rig.hpp"

namespace tappet::bench {
namespace {

TEST(LoomUtility, survives_ten_seconds_without_its_modbus_device_and_counts_the_outage) {
    Loom loom{"--stop-modbus-at 3s/10s"};
    ASSERT_TRUE(loom.weaves()) << loom.machine->output();
    loom.forget();
    EXPECT_TRUE(soon([&] { return loom.last("outages") == "1"; }, 15s)) << loom.since();
    EXPECT_TRUE(loom.weaves());
    EXPECT_EQ(loom.since().find("the loom goes to"), std::string::npos);
    EXPECT_EQ(loom.last("stops"), "0") << "not once did it stop";
    EXPECT_GT(loom.picks(), 80);
    EXPECT_EQ(loom.end(), 0);
    EXPECT_EQ(number_in(loom.summary, "modbus_outages_survived"), 1);
    expect_undisturbed(loom);
}

} // namespace
} // namespace tappet::bench
