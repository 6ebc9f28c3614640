// The list of kinds of real devices: outside of its folder and its tests, a driver appears only here, by an
// include and a name.
#pragma once

#include "drivers/camera/real_camera.hpp"
#include "drivers/can/real_bus.hpp"
#include "drivers/gpio/real_chip.hpp"
#include "drivers/modbus/real_server.hpp"
#include "drivers/udp/real_port.hpp"

namespace tappet {

template <template <class...> class List>
using RealKinds = List<camera::RealCamera, can::RealBus, gpio::RealChip, modbus::RealServer, udp::RealPort>;

} // namespace tappet
