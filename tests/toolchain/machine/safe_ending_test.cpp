// How a guardian ends a machine: the order of its steps, its report on the outputs, and how long it kicks the
// watchdog.
#include "toolchain/machine/safe_ending.hpp"

#include "kernel/os/clock.hpp"
#include "kernel/os/sleep.hpp"
#include "tests/kernel/os/watchdog_device.hpp"
#include "tests/toolchain/machine/firmware_on_host.hpp"
#include "toolchain/machine/firmware.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace tappet {
namespace {

using testing::Contains;
using testing::ElementsAre;

class Wires final : public test::NoDevices {
public:
    std::vector<std::string>& done;
    std::size_t dead_chips = 0;
    int server_steps = 1;
    explicit Wires(std::vector<std::string>& to) : done{to} {}

    std::size_t write_safe_lines() noexcept override {
        done.emplace_back("lines");
        return dead_chips;
    }
    std::size_t send_safe_frames(Duration) noexcept override {
        done.emplace_back("frames");
        return 2;
    }
    std::size_t write_safe_registers(Duration within, const Meanwhile& meanwhile) noexcept override {
        EXPECT_LT(within, os::guardian_acts_within);
        done.emplace_back("registers");
        for (int i = 0; i < server_steps; ++i) {
            os::sleep_for(150ms); // the watchdog of these tests takes a kick every 125 ms
            meanwhile();
        }
        return 1;
    }
};

class Process final : public EndedProcess {
public:
    std::vector<std::string>& done;
    bool ends = true;
    int late_looks = 0; ///< that many polls still find it alive
    explicit Process(std::vector<std::string>& to) : done{to} {}
    void kill() noexcept override { done.emplace_back("kill"); }
    bool await_end(Duration time) noexcept override {
        if (!ends) os::sleep_for(time);
        return ends && late_looks-- <= 0;
    }
};

struct ASafeEnding : testing::Test {
    std::vector<std::string> done{};
    Wires wires{done};
    Process process{done};
    os::WatchdogDevice device{1};
    os::OutputLatch outputs{};
    os::Watchdog watchdog{outputs};

    SafeEnding end() {
        EXPECT_TRUE(watchdog.open(device.path(), 1s));
        EXPECT_TRUE(outputs.drive(os::Clock::monotonic() + 1s));
        return end_safely(process, wires, outputs, watchdog);
    }
    bool a_kick_goes_through() {
        const int before = device.kicks();
        os::sleep_for(150ms);
        watchdog.kick(os::Clock::monotonic());
        return device.kicks() != before;
    }
};

TEST_F(ASafeEnding, writes_the_lines_first_and_again_after_every_possible_racing_write) {
    const SafeEnding ending = end();
    EXPECT_THAT(done, ElementsAre("kill", "lines", "lines", "frames", "registers", "lines"));
    EXPECT_TRUE(ending.outputs_are_safe());
    EXPECT_EQ(ending.frames, 2u);
    EXPECT_EQ(ending.servers, 1u);
    EXPECT_TRUE(outputs.is_safe());
    EXPECT_TRUE(a_kick_goes_through());
    watchdog.stand_down();
    EXPECT_TRUE(device.is_stood_down());
}

TEST_F(ASafeEnding, writes_everything_again_when_the_process_ends_late) {
    process.late_looks = 2;
    EXPECT_TRUE(end().outputs_are_safe());
    EXPECT_THAT(done,
                ElementsAre("kill", "lines", "lines", "frames", "registers", "lines", "frames", "registers"));
}

TEST_F(ASafeEnding, kicks_the_watchdog_while_servers_are_asked) {
    wires.server_steps = 10;
    EXPECT_TRUE(end().outputs_are_safe());
    EXPECT_GE(device.kicks(), 10);
}

TEST_F(ASafeEnding, leaves_the_box_to_its_watchdog_when_a_chip_does_not_answer) {
    wires.dead_chips = 1;
    EXPECT_FALSE(end().outputs_are_safe());
    EXPECT_EQ(outputs.state(), os::OutputLatch::State::unsafe);
    EXPECT_FALSE(a_kick_goes_through());
    watchdog.stand_down();
    EXPECT_FALSE(device.is_stood_down());
}

TEST_F(ASafeEnding, is_never_reported_as_a_wrong_set_up) {
    EXPECT_EQ(code_handed_on(static_cast<int>(Ending::wrong_set_up)),
              static_cast<int>(Ending::stopped_by_fault));
    for (const int code : {0, 3, 4, 137, 139}) EXPECT_EQ(code_handed_on(code), code);
}

TEST_F(ASafeEnding, leaves_the_box_to_its_watchdog_when_the_process_does_not_end) {
    process.ends = false;
    const Time begin = os::Clock::monotonic();
    EXPECT_FALSE(end().outputs_are_safe());
    EXPECT_GE(device.kicks(), 3) << "it is waited for";
    EXPECT_LT(os::Clock::monotonic() - begin, 60s);
    EXPECT_FALSE(a_kick_goes_through());
    EXPECT_THAT(done, Contains("registers"));
}

} // namespace
} // namespace tappet
