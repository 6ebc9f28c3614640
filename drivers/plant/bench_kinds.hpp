// The list of device kinds with a plant's end on the bench: an include and a name each.
#pragma once

#include "drivers/can/bench_bus.hpp"
#include "drivers/gpio/bench_lines.hpp"
#include "drivers/modbus/bench_server.hpp"
#include "drivers/udp/bench_port.hpp"

namespace tappet {

template <template <class...> class List>
using BenchKinds = List<can::BenchBus, gpio::BenchLines, modbus::BenchServer, udp::BenchPort>;

} // namespace tappet
