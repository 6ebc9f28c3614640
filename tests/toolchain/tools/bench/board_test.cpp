// A scenario creates exactly the devices of the board "bench" for a machine.
#include "board/bench/board.hpp"
#include "toolchain/tools/bench/bench.hpp"

#include <gtest/gtest.h>

#include <string>

namespace tappet::bench {
namespace {

TEST(Board, gives_a_scenario_every_device_of_the_bench) {
    Scenario scenario;
    add_board(scenario);
    std::size_t found = 0, own = 0;
    for (const BoardDevice& device : board::bench.devices) {
        if (device.kind == "serial") ++own; // a pseudo-terminal, which each case creates itself
        for (const std::string& bus : scenario.can)
            if (device.kind == "can" && device.address == bus) ++found;
        const Fact* lines = said(device.facts, gpio::lines_word);
        for (const GpioChip& chip : scenario.gpio)
            if (device.address == "/dev/" + chip.name && lines != nullptr &&
                static_cast<std::int64_t>(chip.lines) == lines->numbers[0])
                ++found;
    }
    EXPECT_EQ(found + own, board::bench.devices.size());
    EXPECT_EQ(found, scenario.can.size() + scenario.gpio.size());
}

} // namespace
} // namespace tappet::bench
