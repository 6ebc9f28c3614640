// A scenario creates exactly the buses and chips of the board "bench" for a machine.
#include "board/bench/board.hpp"
#include "toolchain/tools/bench/bench.hpp"

#include <gtest/gtest.h>

#include <string>

namespace tappet::bench {
namespace {

TEST(Board, gives_a_scenario_every_wire_of_the_bench) {
    Scenario scenario;
    add_board(scenario);
    std::size_t found = 0, own = 0;
    for (const BoardDevice& device : board::bench.devices) {
        // A pseudo-terminal, which each case creates itself; a camera, which takes memory and is asked for.
        if (device.kind == "serial" || device.kind == "camera") ++own;
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
