// The bench's plant of a machine: the program at the other end of SocketCAN, gpio-sim and Modbus TCP, in real
// time.
#pragma once

#include "drivers/plant/plant.hpp"
#include "kernel/machine/table/binding.hpp"
#include "kernel/machine/table/board.hpp"
#include "kernel/machine/table/machine.hpp"

#include <functional>
#include <memory>

namespace tappet {

/// Runs until the plant is done and has rested for half a second, or until a signal asks it to end. Exit
/// code: 0 well, 1 the plant found a fault, 2 a wrong set-up.
[[nodiscard]] int run_plant(const MachineView& machine, const Board& board, const Binding& binding,
                            const std::function<std::unique_ptr<Plant>(std::uint64_t seed)>& make_plant,
                            int count, char** words);

} // namespace tappet
