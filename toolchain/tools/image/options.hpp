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
           .help = "the loader starts the watchdog with this time-out before it starts the kernel (default "
                   "30); 0: the box has no watchdog",
           .is_number = true,
           .least = 0,
           .most = 255},
    Option{"--key", "DIR",
           "folder of keys that `tappet-image key` made: signs the image for Secure Boot and writes a signed "
           "update; the box accepts only updates that are signed with these keys"},
    Option{"--next-key", "DIR",
           "folder of the new keys: the box accepts later updates only if they are signed with these keys"}};

inline constexpr std::array box_options{
    Option{"--key", "DIR", "folder of keys that `tappet-image key` made; signs the order"}};

inline constexpr std::array flash_options{Option{"--image", "FILE", "a disk.img"},
                                          Option{"--erase", "", "overwrites a disk that is not empty"}};

} // namespace tappet::image
