// SPDX-License-Identifier: Apache-2.0
// Describes what a box must bring up for its firmware, as lines that the box's init reads.
#pragma once

#include "kernel/machine/plan/places.hpp"

namespace tappet {

/// Writes the tables of board and binding, one word and its values per line, without line end:
/// "device can can0 500000". The image's writer stores them in the image. Lists only the board's devices that
/// the machine is bound to.
void describe_board(const AcceptedMachine& machine, void* to, void (*line)(void* to, std::string_view));

} // namespace tappet
