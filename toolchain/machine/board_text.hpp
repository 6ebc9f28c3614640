// SPDX-License-Identifier: Apache-2.0
// What a box must bring up for its firmware, as lines that the box's init reads.
#pragma once

#include "kernel/machine/plan/places.hpp"

namespace tappet {

/// From the board's and the binding's tables, a word and its values a line, without its end: "can can0
/// 500000". The image's writer keeps them in the image. Of the board's devices those that the machine is
/// bound to.
void describe_board(const AcceptedMachine& machine, void* to, void (*line)(void* to, std::string_view));

} // namespace tappet
