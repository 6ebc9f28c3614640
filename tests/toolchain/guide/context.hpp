// What the machines of the guide's pages stand on, read once for all of their units.
#pragma once

#include "board/bench/board.hpp"
#include "board/host/board.hpp"
#include "drivers/can/bus.hpp"
#include "drivers/can/far_end.hpp"
#include "drivers/can/restarter.hpp"
#include "drivers/gpio/far_end.hpp"
#include "drivers/gpio/line_port.hpp"
#include "drivers/instruments/analog.hpp"
#include "drivers/instruments/encoder.hpp"
#include "drivers/instruments/force_sensor.hpp"
#include "drivers/instruments/velocity_axis.hpp"
#include "drivers/modbus/client.hpp"
#include "drivers/modbus/far_end.hpp"
#include "drivers/plant/plant.hpp"
#include "kernel/control/control.hpp"
#include "kernel/limits/limits.hpp"
#include "kernel/machine/firmware.hpp"
#include "kernel/machine/table/compiled.hpp"
#include "kernel/machine/table/machine.hpp"
#include "kernel/pieces/cam_shaft.hpp"
#include "kernel/services/browsing/browser_service.hpp"
#include "kernel/services/reporting/reporting.hpp"
#include "kernel/services/scope/thread_scope.hpp"
#include "toolchain/machine/host.hpp"

#include <gtest/gtest.h>
