// SPDX-License-Identifier: Apache-2.0
// Writes an image to a disk, and never to the wrong one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace tappet::image {

/// Returns empty when the image may be written there. Otherwise the reason and the cure: a part of the device
/// is mounted or used for swap, it is too small, or it holds data and `erase` was not given.
[[nodiscard]] std::string refusal_to_flash(const std::filesystem::path& image,
                                           const std::filesystem::path& device, bool erase);

/// Writes every byte, reads every byte back from the disk itself, and compares. Blocks; calls `done` with the
/// progress. Throws a Fault on failure.
void flash(const std::filesystem::path& image, const std::filesystem::path& device,
           const std::function<void(std::uint64_t bytes, std::uint64_t of)>& done);

} // namespace tappet::image
