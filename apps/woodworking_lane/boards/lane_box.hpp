// The box of each machine of the lane: an industrial PC whose first CAN port runs as fast as 100 m of wire
// allow.
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
