// SPDX-License-Identifier: Apache-2.0
// Sets up the kernel before anything runs: modules, interfaces, CAN bit rates, simulated CAN and GPIO. Does
// not wait for hardware.
#pragma once

#include "board/init/system.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::init {

/// Whether a module keeps its signature. A kernel that is locked down requires a valid one. Any other kernel
/// checks it too, which takes time, and loads modules without one; when the kernel itself was not verified,
/// that check proves nothing.
enum class Signature : std::uint8_t { on, off };
/// Loads one module's file with its parameters; succeeds when it is already loaded.
[[nodiscard]] Done load_module(const std::string& path, const std::string& parameters = {},
                               Signature signature = Signature::on);
/// Returns the module without its signature; unchanged when it has none.
[[nodiscard]] std::string_view without_signature(std::string_view module);
/// Loads all of them, whatever their dependencies.
[[nodiscard]] Done load_modules(std::vector<std::string> paths);

[[nodiscard]] bool has_interface(const std::string& name);
[[nodiscard]] Done set_link(const std::string& name, bool up);
/// Sets an address: "192.168.7.1/24".
[[nodiscard]] Done set_address(const std::string& name, const std::string& address);
/// Sets the bit rates of a CAN controller that is down, with CAN FD when `in_data_phase` is not 0. Disables
/// automatic restart: bus-off is a fault that the machine handles.
[[nodiscard]] Done set_bit_rates(const std::string& name, std::uint32_t bits_per_second,
                                 std::uint32_t in_data_phase);

/// Creates a virtual CAN interface with CAN FD, and brings it up.
[[nodiscard]] Done create_can(const std::string& name);
/// Creates a simulated GPIO chip with the same name on both sides: a driver opens the character device
/// /dev/NAME; the outside world pulls inputs and reads outputs in the folder /sim/NAME (sim_gpioN/pull,
/// sim_gpioN/value).
[[nodiscard]] Done create_gpio_chip(const std::string& name, const std::string& lines);

} // namespace tappet::init
