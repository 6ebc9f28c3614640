// SPDX-License-Identifier: Apache-2.0
// What changes a box: an update or an order that came over the network, or an update on a stick. The machine
// stands, and who pressed the button is at it.
#pragma once

#include "board/box/disk.hpp"
#include "board/box/facts.hpp"
#include "board/box/modules.hpp"
#include "board/box/slots.hpp"
#include "board/box/update.hpp"
#include "board/box/voice.hpp"

namespace tappet::box {

/// The box's own, as its image says.
[[nodiscard]] Manifest manifest_of(const Facts& facts);

/// On the data partition: what the order "measure" found.
inline constexpr const char* measured_file = "measured";

/// Carries out what waits, and says what came of it. True when there is something to start anew for.
/// `data`: the data partition, which is mounted nowhere.
[[nodiscard]] bool renew(const Facts& facts, const std::string& nonce, const std::string& data, Slots& slots,
                         Modules& modules, const Voice& voice);

} // namespace tappet::box
