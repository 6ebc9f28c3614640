// Examples of what a machine's CAN and Modbus drivers put on their wires, to hold beside a device's manual.
#pragma once

#include "kernel/machine/plan/places.hpp"

#include <string>

namespace tappet {

/// Returns, for each signal and each register of the table's maps, a value and its bytes or words on the
/// wire, line by line. The value is the upper end of the row's range; without one 1.5 units, or the nearest
/// that the row can express. The drivers' own encoders compute the bytes. Not real-time.
[[nodiscard]] std::string describe_wires(const MachineView& table);

/// Returns the number in hexadecimal digits, with zeros before it. Not real-time.
[[nodiscard]] std::string in_hex(std::uint64_t number, int digits);

} // namespace tappet
