// The box of each machine of the lane: an industrial PC whose first CAN port runs at the highest rate for 100
// m of wire.
#pragma once

#include "board/ipc-x86_64/board.hpp"

namespace tappet::board {

inline constexpr Board lane_box = [] {
    Board box = ipc_x86_64;
    box.name = "lane-box";
    for (BoardDevice& device : box.devices)
        if (device.name == "can0") device.say(bit_rate(500'000));
    return box;
}();

} // namespace tappet::board
