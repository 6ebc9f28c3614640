// SPDX-License-Identifier: Apache-2.0
// An image onto a disk, and nothing onto the wrong one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace tappet::image {

/// Empty: the image may be written there. Else why not, and the cure: a part of it is mounted or swapped to,
/// it is too small, or it holds something and `erase` was not said.
[[nodiscard]] std::string refusal_to_flash(const std::filesystem::path& image,
                                           const std::filesystem::path& device, bool erase);

/// Writes every byte, reads every byte back from the disk itself, and compares. Blocks; `done` is told how
/// far. What is wrong is thrown as a Fault.
void flash(const std::filesystem::path& image, const std::filesystem::path& device,
           const std::function<void(std::uint64_t bytes, std::uint64_t of)>& done);

} // namespace tappet::image
