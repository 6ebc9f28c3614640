// SPDX-License-Identifier: Apache-2.0
// Reads an update from a USB stick while the machine is stopped.
#pragma once

#include "board/box/update.hpp"

#include <expected>
#include <optional>
#include <string>

namespace tappet::box {

/// Returns the disk that holds an update; empty when there is none. Does not verify it.
[[nodiscard]] std::optional<std::string> find_update();
/// Returns whether a USB mass-storage device is present, whose disk may be about to appear.
[[nodiscard]] bool has_usb_storage();

/// Reads the update into memory, verifies it there, and returns that copy, so that a stick cannot change its
/// contents after the check. The error is a sentence.
[[nodiscard]] std::expected<Update, std::string> read_update(const std::string& disk, const PublicKey& key);

} // namespace tappet::box
