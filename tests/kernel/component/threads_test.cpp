// Only its own activity uses a resource: a component its device, an activity its ports.
#include "kernel/component/one_activity.hpp"
#include "tests/kernel/component/port_rig.hpp"

namespace {

using namespace tappet;

TEST(OneActivity, accepts_its_first_activity_and_threads_without_one) {
    OneActivity device;
    device.used(); // at start-up: no activity owns it yet
    for (int again = 0; again < 2; ++again) {
        const RunsActivity here{3};
        device.used();
    }
    device.used(); // the supervisor, at the end
}

TEST(OneActivityDeathTest, refuses_any_other_activity) {
    OneActivity device;
    {
        const RunsActivity here{3};
        device.used();
    }
    const RunsActivity there{4};
    EXPECT_DEATH(device.used(), "contract 109 one-activity: A device of activity 3 was used in activity 4");
}

#ifdef TAPPET_ASSERTS_THREADS

struct PortsOfAnActivityDeathTest : testing::Test, LinkedPorts<double> {
    Time others = at_ns(0);

    PortsOfAnActivityDeathTest() : LinkedPorts{false} {}
};

TEST_F(PortsOfAnActivityDeathTest, accept_their_activity_and_threads_without_one) {
    output.write(1.0);
    const RunsActivity here{0, &now};
    output.write(2.0);
    EXPECT_EQ(input.get(), 2.0);
}

TEST_F(PortsOfAnActivityDeathTest, refuse_a_write_in_another_activity) {
    const RunsActivity there{1, &others};
    EXPECT_DEATH(output.write(1.0), "contract 103 single-writer: An output was written in activity 1");
}

TEST_F(PortsOfAnActivityDeathTest, refuse_a_read_in_another_activity) {
    const RunsActivity there{1, &others};
    double value = 0;
    EXPECT_DEATH(static_cast<void>(input.get()),
                 "contract 104 single-reader: An input was read in activity 1");
    EXPECT_DEATH(static_cast<void>(input.read(value)), "contract 104 single-reader");
}

#endif

} // namespace
