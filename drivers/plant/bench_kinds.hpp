// The kinds of devices that a bench has the plant's ends of: an include and a name each.
#pragma once

#include "drivers/can/bench_bus.hpp"
#include "drivers/gpio/bench_lines.hpp"
#include "drivers/modbus/bench_server.hpp"
#include "drivers/udp/bench_port.hpp"

namespace tappet {

template <template <class...> class List>
using BenchKinds = List<can::BenchBus, gpio::BenchLines, modbus::BenchServer, udp::BenchPort>;

} // namespace tappet
