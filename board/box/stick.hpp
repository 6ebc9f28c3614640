// SPDX-License-Identifier: Apache-2.0
// Takes an update from a stick that somebody plugged in, while the machine stands.
#pragma once

#include "board/box/update.hpp"

#include <expected>
#include <optional>
#include <string>

namespace tappet::box {

/// The disk that holds an update; none when there is none. Nothing of it is judged.
[[nodiscard]] std::optional<std::string> find_update();
/// Whether a USB device calls itself a store of data: its disk may be about to come.
[[nodiscard]] bool has_usb_storage();

/// All of it into memory, then judged, then written from there: a stick that changes its mind changes
/// nothing. The error: a sentence.
[[nodiscard]] std::expected<Update, std::string> read_update(const std::string& disk, const PublicKey& key);

} // namespace tappet::box
