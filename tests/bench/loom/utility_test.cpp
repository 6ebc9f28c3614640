// The climate and lubrication unit disappears for some seconds: the loom weaves on with the last known oil
// pressure. The longest allowed absence is tested in virtual time.
#include "tests/bench/loom/loom_rig.hpp"

namespace tappet::bench {
namespace {

TEST(LoomUtility, survives_seconds_without_its_modbus_device_and_counts_the_outage) {
    Loom loom{"--stop-servers-at 3s/3s"};
    ASSERT_TRUE(loom.weaves()) << loom.machine->output();
    loom.forget();
    EXPECT_TRUE(loom.says("outages=1")) << "told when it begins:\n" << loom.since();
    std::this_thread::sleep_for(4s); // its end, and the client's pause before it retries
    loom.forget();
    EXPECT_TRUE(loom.weaves());
    EXPECT_EQ(loom.machine->output().find("the loom goes to"), std::string::npos) << loom.machine->output();
    EXPECT_EQ(loom.last("stops"), "0") << "not once did it stop";
    EXPECT_GT(loom.picks(), 20);
    EXPECT_EQ(loom.end(), 0);
    EXPECT_EQ(number_in(loom.summary, "utility.outages_survived"), 1);
    expect_undisturbed(loom);
}

} // namespace
} // namespace tappet::bench
