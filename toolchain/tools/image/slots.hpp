// SPDX-License-Identifier: Apache-2.0
// A new version into the slot that is not in use, of a disk or of its image.
#pragma once

#include "toolchain/tools/image/disk.hpp"

namespace tappet::image {

/// Writes the unified kernel image into the slot that the loader would boot last, reads it back, and puts it
/// on trial, which is the last write: whatever interrupts it, the other slot boots. The new revision. A
/// fault: the disk is not of ours, or does not keep what is written.
std::uint32_t install(const std::filesystem::path& disk, const std::filesystem::path& kernel);

/// As its loader's file says. The error is why the loader would pass it over.
std::expected<init::BootState, std::string> read_slot(const std::filesystem::path& disk,
                                                      const Partition& slot);

} // namespace tappet::image
