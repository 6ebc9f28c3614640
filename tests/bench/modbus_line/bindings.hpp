// The place of this machine's device on the bench.
#pragma once

#include "drivers/modbus/kind.hpp"
#include "kernel/machine/table/binding.hpp"

namespace tappet::modbus_line::bindings {

// A pseudo-terminal has no parity.
inline constexpr Binding bench =
    binding(wired("line", "line", unit(1), serial_line(19'200, 'N', 1), answer_within(300ms)));

} // namespace tappet::modbus_line::bindings
