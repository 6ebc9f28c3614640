// What a scenario brings up for a machine is what the board "bench" says.
#include "board/bench/board.hpp"
#include "toolchain/tools/bench/bench.hpp"

#include <gtest/gtest.h>

#include <string>

namespace tappet::bench {
namespace {

TEST(Board, of_a_scenario_has_every_device_that_the_bench_says) {
    Scenario scenario;
    add_board(scenario);
    std::size_t found = 0, own = 0;
    for (const BoardDevice& device : board::bench.devices) {
        if (device.kind == "serial") ++own; // a pseudo-terminal, which a case makes itself
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
