// What belongs to one activity is used by it alone: a device by its component, a port by its own.
#include "kernel/component/one_activity.hpp"
#include "tests/kernel/component/port_rig.hpp"

namespace {

using namespace tappet;

TEST(OneActivity, is_the_first_that_uses_it_and_whoever_runs_none) {
    OneActivity device;
    device.used(); // at start-up: nobody's yet
    for (int again = 0; again < 2; ++again) {
        const RunsActivity here{3};
        device.used();
    }
    device.used(); // the supervisor, at the end
}

TEST(OneActivityDeathTest, is_not_any_other) {
    OneActivity device;
    {
        const RunsActivity here{3};
        device.used();
    }
    const RunsActivity there{4};
    EXPECT_DEATH(device.used(),
                 "contract 109 one-activity: A device that activity 3 uses was used in activity 4");
}

#ifdef TAPPET_ASSERTS_THREADS

struct PortsOfAnActivityDeathTest : testing::Test, LinkedPorts<double> {
    Time others = at_ns(0);

    PortsOfAnActivityDeathTest() : LinkedPorts{false} {}
};

TEST_F(PortsOfAnActivityDeathTest, are_used_in_it_and_by_who_runs_none) {
    output.write(1.0);
    const RunsActivity here{0, &now};
    output.write(2.0);
    EXPECT_EQ(input.get(), 2.0);
}

TEST_F(PortsOfAnActivityDeathTest, are_not_written_in_another) {
    const RunsActivity there{1, &others};
    EXPECT_DEATH(output.write(1.0), "contract 103 single-writer: An output was written in activity 1");
}

TEST_F(PortsOfAnActivityDeathTest, are_not_read_in_another) {
    const RunsActivity there{1, &others};
    double value = 0;
    EXPECT_DEATH(static_cast<void>(input.get()),
                 "contract 104 single-reader: An input was read in activity 1");
    EXPECT_DEATH(static_cast<void>(input.read(value)), "contract 104 single-reader");
}

#endif

} // namespace
