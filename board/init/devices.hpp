// SPDX-License-Identifier: Apache-2.0
// What the kernel is given before anything runs: modules, interfaces, CAN bit rates, simulated CAN and GPIO.
// Nothing here waits for hardware.
#pragma once

#include "board/init/system.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::init {

/// Of a kernel that is locked down a module's signature must be right; any other judges it too, and takes its
/// time, and then loads what has none. Where nobody has judged the kernel itself, that proves nothing.
enum class Signature : std::uint8_t { on, off };
/// One module's file, with its parameters; well when it is loaded already.
[[nodiscard]] Done load_module(const std::string& path, const std::string& parameters = {},
                               Signature signature = Signature::on);
/// As it was before its maker signed it; one that has no signature stays as it is.
[[nodiscard]] std::string_view without_signature(std::string_view module);
/// All of them, in whatever order they need each other.
[[nodiscard]] Done load_modules(std::vector<std::string> paths);

[[nodiscard]] bool has_interface(const std::string& name);
[[nodiscard]] Done set_link(const std::string& name, bool up);
/// "192.168.7.1/24".
[[nodiscard]] Done set_address(const std::string& name, const std::string& address);
/// Of a CAN controller that is down, which is set to CAN FD when `in_data_phase` is not 0; a bus that goes
/// off stays off, since that is a fault which its machine handles.
[[nodiscard]] Done set_bit_rates(const std::string& name, std::uint32_t bits_per_second,
                                 std::uint32_t in_data_phase);

/// A virtual CAN interface, up; it takes CAN FD.
[[nodiscard]] Done create_can(const std::string& name);
/// A chip is reached by its name on both sides: /dev/NAME is the character device a driver opens, /sim/NAME
/// is the folder in which the outside world pulls inputs and reads outputs (sim_gpioN/pull, sim_gpioN/value).
[[nodiscard]] Done create_gpio_chip(const std::string& name, const std::string& lines);

} // namespace tappet::init
