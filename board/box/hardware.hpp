// SPDX-License-Identifier: Apache-2.0
// Brings up the hardware in a board's facts as it appears, and reports what is missing.
#pragma once

#include "board/box/facts.hpp"
#include "board/box/modules.hpp"
#include "board/box/voice.hpp"

#include <chrono>
#include <functional>

namespace tappet::box {

/// One item of hardware that the box should have.
struct Need {
    std::string what{};
    std::string cure{};
    std::function<bool()> is_there{};
    std::function<init::Done()> bring_up{};
    bool is_up = false;
};

/// Returns the devices that a machine needs to arm. CAN interfaces are set up; devices of other kinds must
/// exist. On an emulated box ("world bench") CAN interfaces and GPIO chips are created instead of awaited.
[[nodiscard]] std::vector<Need> needs_of(const Facts& facts);
/// Returns the Ethernet ports; the devices at their other end may come and go.
[[nodiscard]] std::vector<Need> networks_of(const Facts& facts);

/// Loads modules and brings up the hardware that is present. Returns whether nothing is missing.
bool bring_up(std::vector<Need>& needs, Modules& modules, Modules::Which which, const Voice& voice);
/// Reports each missing item in one sentence.
void tell_missing(const std::vector<Need>& needs, const Voice& voice);

/// Sets the frequency governor of every processor that has one, so that the frequency does not change.
void set_governor(const Voice& voice);
/// See init::stop_throttling.
void stop_throttling(const Voice& voice);

/// Sets the priority of the bound devices' interrupt threads, which exist once a device is opened.
void raise_interrupts(const Facts& facts, const Voice& voice);

/// Returns whether the kernel is locked down: the box's UEFI firmware verified it (Secure Boot).
[[nodiscard]] bool is_locked_down();

} // namespace tappet::box
