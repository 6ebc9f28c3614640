// SPDX-License-Identifier: Apache-2.0
// Changes to a box: an update or an order that came over the network, or an update on a stick. The machine is
// stopped, and the person who pressed the button is at it.
#pragma once

#include "board/box/disk.hpp"
#include "board/box/facts.hpp"
#include "board/box/modules.hpp"
#include "board/box/slots.hpp"
#include "board/box/update.hpp"
#include "board/box/voice.hpp"

namespace tappet::box {

/// Returns the box's own manifest, from its image.
[[nodiscard]] Manifest manifest_of(const Facts& facts);

/// File on the data partition with the result of the order "measure".
inline constexpr const char* measured_file = "measured";

/// Processes pending updates and orders, and reports the result. Returns true when the box must restart.
/// `data`: the data partition, which is not mounted.
[[nodiscard]] bool renew(const Facts& facts, const std::string& nonce, const std::string& data, Slots& slots,
                         Modules& modules, const Voice& voice);

} // namespace tappet::box
