// SPDX-License-Identifier: Apache-2.0
// Installs a new version into the unused slot of a disk or of its image.
#pragma once

#include "toolchain/tools/image/disk.hpp"

namespace tappet::image {

/// Writes the unified kernel image into the slot that the loader would boot last, reads it back, and marks it
/// as on trial, which is the last write: after any interruption the other slot boots. Returns the new
/// revision. Throws a fault when the disk is not a Tappet disk, or does not keep the written data.
std::uint32_t install(const std::filesystem::path& disk, const std::filesystem::path& kernel);

/// Returns the state in the loader's file. The error is why the loader would skip the slot.
std::expected<init::BootState, std::string> read_slot(const std::filesystem::path& disk,
                                                      const Partition& slot);

} // namespace tappet::image
