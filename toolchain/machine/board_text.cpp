// SPDX-License-Identifier: Apache-2.0
// Lines of one word and its values.
#include "toolchain/machine/board_text.hpp"

#include "kernel/machine/check/board.hpp"

namespace tappet {

void describe_board(const AcceptedMachine& machine, void* to, void (*line)(void* to, std::string_view)) {
    const Board& board = *machine.board;
    const auto say = [&](const auto&... words) { line(to, Sentence{words...}.view()); };
    say("machine ", machine.table.name);
    say("board ", board.name);
    say("world ", board.world);
    say("kernel ", board.kernel_command_line);
    for (const std::string_view each : board.image.consoles) say("console ", each);
    for (const std::string_view each : board.image.modules) say("module ", each);
    for (const BoundDevice& bound : machine.binding->devices)
        if (const BoardDevice* device = checks::find_named(board.devices, bound.at); device != nullptr) {
            const std::size_t value =
                device->kind == "can" ? device->bit_rate.bits_per_second : device->lines;
            say(device->kind, " ", device->address, " ", value);
        }
    for (const BoardNetwork& each : board.image.networks) say("network ", each.name, " ", each.address);
    if (board.image.interrupt_priority != 0) say("interrupts ", board.image.interrupt_priority);
    if (board.watchdog != nullptr)
        say("watchdog ", board.watchdog, " ", static_cast<std::int64_t>(board.watchdog_within / 1s));
    // What is kept must outlive the power: the data partition is mounted there.
    if (board.properties_directory.starts_with("/var/")) say("data ", board.properties_directory);
    say("restarts ", board.image.restarts.most, " ",
        static_cast<std::int64_t>(board.image.restarts.within / 1s));
}

} // namespace tappet
