// SPDX-License-Identifier: Apache-2.0
// Brings up what a board's facts name, as it appears, and says what is missing.
#pragma once

#include "board/box/facts.hpp"
#include "board/box/modules.hpp"
#include "board/box/voice.hpp"

#include <chrono>
#include <functional>

namespace tappet::box {

/// One thing that the box is said to have.
struct Need {
    std::string what{};
    std::string cure{};
    std::function<bool()> is_there{};
    std::function<init::Done()> bring_up{};
    bool is_up = false;
};

/// What the facts name and a machine needs to arm: CAN, GPIO and serial ports. On an emulated box ("world
/// bench") CAN interfaces and GPIO chips are made instead of awaited.
[[nodiscard]] std::vector<Need> needs_of(const Facts& facts);
/// Ethernet ports: who is at their other end comes and goes.
[[nodiscard]] std::vector<Need> networks_of(const Facts& facts);

/// Loads modules and brings up what is there. Whether nothing is missing now.
bool bring_up(std::vector<Need>& needs, Modules& modules, Modules::Which which, const Voice& voice);
/// One sentence for each thing that is missing.
void tell_missing(const std::vector<Need>& needs, const Voice& voice);

/// The governor of every processor that has one: no change of frequency.
void set_governor(const Voice& voice);
/// See init::stop_throttling.
void stop_throttling(const Voice& voice);

/// The threads of the bound devices' interrupts, which the kernel starts when somebody opens the device.
void raise_interrupts(const Facts& facts, const Voice& voice);

/// The kernel locks itself down when the box's firmware says that it checked it: Secure Boot.
[[nodiscard]] bool is_locked_down();

} // namespace tappet::box
