// The list of device kinds with a twin on the host: an include and a name each.
#pragma once

#include "drivers/camera/simulated_camera.hpp"
#include "drivers/can/simulated_bus.hpp"
#include "drivers/gpio/simulated_chip.hpp"
#include "drivers/modbus/simulated_server.hpp"
#include "drivers/udp/simulated_port.hpp"

namespace tappet {

template <template <class...> class List>
using SimulatedKinds = List<camera::SimulatedCamera, can::SimulatedBus, gpio::SimulatedChip,
                            modbus::SimulatedServer, udp::SimulatedPort>;

} // namespace tappet
