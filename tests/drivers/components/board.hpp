// The box that the small machines of these tests run on.
#pragma once

#include "kernel/machine/table/board.hpp"

namespace tappet::test {

constexpr Board make_board() {
    Board board;
    board.name = "test";
    board.world = "host";
    board.memory_budget_bytes = 4u << 20;
    static_cast<void>(board.devices.push(board_device("wire", "can", "twin", bit_rate(500'000))));
    static_cast<void>(
        board.devices.push(board_device("lines", "gpio", "twin", line("stop_button", 0), line("weft", 1),
                                        line("lamp", 2), line("valve", 3), line("brake", 4))));
    static_cast<void>(board.devices.push(board_device("server", "modbus", "twin")));
    return board;
}
inline constexpr Board board = make_board();

} // namespace tappet::test
