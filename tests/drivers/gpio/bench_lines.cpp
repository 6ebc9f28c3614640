// The real GPIO device on a real kernel's simulated chip, with libgpiod's tools as peers. Runs on the bench:
// /dev/panel with 16 lines, its outside below /sim/panel.
#include "drivers/gpio/lines.hpp"
#include "kernel/os/clock.hpp"
#include "kernel/os/waiter.hpp"
#include "tests/drivers/foreign.hpp"

#include <gtest/gtest.h>

#include <array>
#include <gpiod.h>
#include <malloc.h>

namespace tappet::gpio {
namespace {

constexpr std::array panel{
    Line{.name = "drop_wire", .offset = 3},
    Line{.name = "detector", .offset = 0, .active_low = true, .bias = Bias::pull_up},
    Line{.name = "button", .offset = 9, .debounce = 20ms},
    Line{.name = "lamp", .offset = 1, .role = Role::output},
    Line{.name = "brake", .offset = 2, .role = Role::output, .safe_value = true},
    Line{.name = "valve", .offset = 5, .role = Role::output, .active_low = true},
};
constexpr std::size_t drop_wire = 0, detector = 1, button = 2, lamp = 3, brake = 4, valve = 5;
constexpr Mask bit(std::size_t line) { return Mask{1} << line; }

Time now() { return os::Clock::monotonic(); }

std::string outside(unsigned offset, const char* what) {
    return "/sim/panel/sim_gpio" + std::to_string(offset) + "/" + what;
}
void pull(unsigned offset, bool up) {
    std::ofstream{outside(offset, "pull")} << (up ? "pull-up" : "pull-down");
}
int seen(unsigned offset) {
    int value = -1;
    std::ifstream{outside(offset, "value")} >> value;
    return value;
}

struct RealLines : testing::Test {
    RealLines() {
        pull(3, false);
        pull(0, true);
        pull(9, false);
    }
    void open() {
        const auto opened = device.open({.chip = "/dev/panel", .lines = panel});
        ASSERT_TRUE(opened) << opened.error().view();
    }
    std::vector<Edge> read() {
        std::vector<Edge> all;
        for (;;) {
            const EdgeBatch batch = device.read_edges(edges);
            if (batch.gap.missed != 0) gap = batch.gap;
            if (batch.count == 0) return all;
            all.insert(all.end(), edges.begin(), edges.begin() + static_cast<std::ptrdiff_t>(batch.count));
        }
    }
    Lines device;
    std::array<Edge, 64> edges{};
    Gap gap{};
};

TEST_F(RealLines, deliver_edges_in_order_with_number_time_and_level) {
    open();
    EXPECT_TRUE(read().empty()) << "and do not block";
    const Time before = now();
    pull(3, true);
    std::this_thread::sleep_for(2ms);
    pull(0, false); // active low: becomes active
    std::this_thread::sleep_for(2ms);
    pull(3, false);
    std::this_thread::sleep_for(2ms);
    const Time after = now();
    const auto got = read();
    ASSERT_EQ(got.size(), 3u);
    EXPECT_EQ(got[0].line, drop_wire);
    EXPECT_TRUE(got[0].rising);
    EXPECT_EQ(got[1].line, detector);
    EXPECT_TRUE(got[1].rising);
    EXPECT_EQ(got[2].line, drop_wire);
    EXPECT_FALSE(got[2].rising);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(got[i].seqno, i + 1);
        EXPECT_GE(got[i].stamp, i == 0 ? before : got[i - 1].stamp + 2ms);
        EXPECT_LE(got[i].stamp, after);
    }
    EXPECT_EQ(device.counters().missed, 0u);
    EXPECT_EQ(device.levels().mask & (bit(drop_wire) | bit(detector)), bit(detector));
}

TEST_F(RealLines, write_outputs_at_once_and_safe_values_at_open_and_close) {
    open();
    EXPECT_EQ(seen(1), 0);
    EXPECT_EQ(seen(2), 1) << "the brake's safe value is on";
    EXPECT_EQ(seen(5), 1) << "inactive of an active-low line";
    EXPECT_TRUE(device.write(bit(lamp) | bit(brake) | bit(valve) | bit(drop_wire), bit(lamp) | bit(valve)));
    EXPECT_EQ(seen(1), 1);
    EXPECT_EQ(seen(2), 0);
    EXPECT_EQ(seen(5), 0);
    EXPECT_TRUE(device.make_safe());
    EXPECT_EQ(seen(1), 0);
    EXPECT_EQ(seen(2), 1);
    EXPECT_EQ(seen(5), 1);
    EXPECT_TRUE(device.write(bit(brake), 0));
    EXPECT_EQ(seen(2), 0);
    const auto writes = device.counters().writes;
    device.close();
    EXPECT_EQ(device.counters().writes, writes + 1)
        << "the safe values; what the chip does with a released line is its own affair";
    EXPECT_EQ(device.counters().failures, 0u);
}

TEST_F(RealLines, report_the_edges_lost_in_a_burst_and_read_the_levels) {
    open();
    for (int i = 0; i < 3001; ++i) pull(3, i % 2 == 0);
    std::this_thread::sleep_for(5ms);
    pull(0, false);
    std::this_thread::sleep_for(5ms);
    const auto got = read();
    EXPECT_GT(gap.missed, 0u);
    EXPECT_TRUE(gap.levels_known);
    EXPECT_EQ(gap.levels & (bit(drop_wire) | bit(detector)), bit(drop_wire) | bit(detector));
    EXPECT_EQ(got.size() + device.counters().missed, 3002u) << "every edge is accounted for";
}

TEST_F(RealLines, leave_debouncing_to_the_kernel) {
    open();
    for (int i = 0; i < 4; ++i) {
        pull(9, true);
        std::this_thread::sleep_for(2ms);
        pull(9, false);
        std::this_thread::sleep_for(2ms);
    }
    std::this_thread::sleep_for(40ms);
    EXPECT_TRUE(read().empty());
    pull(9, true);
    std::this_thread::sleep_for(60ms);
    const auto got = read();
    ASSERT_EQ(got.size(), 1u);
    EXPECT_EQ(got[0].line, button);
    EXPECT_TRUE(got[0].rising);
}

TEST_F(RealLines, are_found_by_the_label_of_their_chip) {
    gpiod_chip* chip = gpiod_chip_open("/dev/panel");
    ASSERT_NE(chip, nullptr);
    gpiod_chip_info* info = gpiod_chip_get_info(chip);
    const std::string label = gpiod_chip_info_get_label(info);
    gpiod_chip_info_free(info);
    gpiod_chip_close(chip);
    const auto opened = device.open({.chip = label, .lines = panel});
    EXPECT_TRUE(opened) << (opened ? "" : opened.error().view());
}

TEST_F(RealLines, show_their_holder_to_another_program) {
    open();
    Foreign info{"gpioinfo -c /dev/panel"};
    EXPECT_EQ(info.wait(), 0);
    EXPECT_NE(info.output().find("consumer=tappet"), std::string::npos) << info.output();
    EXPECT_NE(run_foreign("gpioset -t0 -c /dev/panel 2=0"), 0) << "nobody else writes the brake";
}

TEST_F(RealLines, are_refused_while_another_program_holds_one) {
    Foreign holder{"gpioset -c /dev/panel 5=1"};
    std::this_thread::sleep_for(500ms);
    const auto opened = device.open({.chip = "/dev/panel", .lines = panel});
    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().view(), "GPIO line \"valve\", line 5 of chip \"/dev/panel\", is in use by "
                                     "\"gpioset\": stop that, or name another line in the board");
}

TEST_F(RealLines, are_refused_when_the_chip_does_not_have_them) {
    constexpr std::array wrong{Line{.name = "a", .offset = 0}, Line{.name = "b", .offset = 16}};
    const auto opened = device.open({.chip = "/dev/panel", .lines = wrong});
    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().view(), "GPIO line \"b\", line 16 of chip \"/dev/panel\", does not exist: "
                                     "correct the offset in the board (gpioinfo lists them)");
}

TEST_F(RealLines, allocate_nothing_while_they_run) {
    open();
    const auto before = ::mallinfo2().uordblks;
    std::uint64_t got = 0;
    for (int i = 0; i < 200; ++i) {
        device.write(bit(lamp), i % 2 == 0 ? bit(lamp) : 0);
        if (device.levels().known) ++got;
        device.read_edges(edges);
    }
    EXPECT_EQ(::mallinfo2().uordblks, before);
    EXPECT_EQ(got, 200u);
}

/// The last test: the chip never comes back.
TEST_F(RealLines, refuse_and_count_every_call_once_the_chip_is_removed) {
    open();
    os::Waiter waiter;
    ASSERT_TRUE(waiter.watch(device.wait_handle()));
    EXPECT_FALSE(waiter.wait(now() + 5ms));
    std::ofstream{"/sys/kernel/config/gpio-sim/panel/live"} << "0";
    int returns = 0;
    for (int i = 0; i < 50; ++i) {
        returns += waiter.wait(now() + 2ms) ? 1 : 0;
        EXPECT_EQ(device.read_edges(edges).count, 0u);
    }
    EXPECT_EQ(returns, 1) << "its descriptor hangs up for ever";
    EXPECT_EQ(device.counters().failures, 50u);
    EXPECT_FALSE(device.levels().known);
    EXPECT_FALSE(device.write(bit(lamp), bit(lamp)));
    EXPECT_FALSE(device.make_safe());
    EXPECT_EQ(device.counters().failures, 53u);
}

} // namespace
} // namespace tappet::gpio
