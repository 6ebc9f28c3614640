// The box of the car tracker: an industrial PC with a camera on USB.
#pragma once

#include "board/ipc-x86_64/board.hpp"
#include "drivers/camera/kind.hpp"

namespace tappet::board {

inline constexpr Board camera_box = [] {
    Board box = ipc_x86_64;
    box.name = "camera-box";
    static_cast<void>(box.devices.push(board_device("camera0", "camera", "/dev/video0", frames(160, 120, 10),
                                                    pixels(camera::Format::yuyv))));
    static_cast<void>(box.image.modules.push("xhci-pci")); // before the machine starts, unlike that of sticks
    static_cast<void>(box.image.modules.push("uvcvideo"));
    return box;
}();

} // namespace tappet::board
