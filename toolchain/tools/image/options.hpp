// SPDX-License-Identifier: Apache-2.0
// The options for an image and for flashing it: of this program, and of `tappet`, which passes them on.
#pragma once

#include "toolchain/command_line.hpp"

#include <array>

namespace tappet::image {

inline constexpr std::array image_options{
    Option{.name = "--version",
           .value = "N",
           .help = "version of the image (default 1)",
           .is_number = true,
           .least = 1,
           .most = 4'000'000'000},
    Option{.name = "--watchdog",
           .value = "SECONDS",
           .help = "armed by the loader before the kernel (default 30); 0: the box has none",
           .is_number = true,
           .least = 0,
           .most = 255},
    Option{
        "--key", "DIR",
        "of tappet-image key: the image is signed for Secure Boot, the box takes updates signed with it, and "
        "one is written"},
    Option{"--next-key", "DIR", "the box's later updates are signed with these instead"}};

inline constexpr std::array box_options{
    Option{"--key", "DIR", "folder of tappet-image key, to sign an order"}};

inline constexpr std::array flash_options{Option{"--image", "FILE", "a disk.img"},
                                          Option{"--erase", "", "overwrites a disk that is not empty"}};

} // namespace tappet::image
