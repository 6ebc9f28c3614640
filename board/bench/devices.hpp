// SPDX-License-Identifier: Apache-2.0
// What the guest's kernel is given before anything runs: modules, the host's ports, CAN interfaces, GPIO
// chips. A device that cannot be made ends the guest with its reason.
#pragma once

#include <string>
#include <vector>

namespace tappet::bench {

void load_modules(std::vector<std::string> modules);

/// The port of this name to the host, opened; waits for it to appear.
int open_port(const std::string& wanted);

void set_link(const std::string& name, bool up);
void create_can(const std::string& name);
void create_gpio_chip(const std::string& name, const std::string& lines);

} // namespace tappet::bench
