// SPDX-License-Identifier: Apache-2.0
// The box's disk: its partitions by name, and the data partition.
#pragma once

#include "board/init/system.hpp"

#include <expected>
#include <functional>
#include <string>

namespace tappet::box {

inline constexpr const char* data_partition = "tappet-data";

/// Returns the device of a partition, "/dev/nvme0n1p4", by its name in the disk's table. The error: there is
/// none (yet), or two disks have one.
[[nodiscard]] std::expected<std::string, std::string> find_partition(const std::string& name);

/// Mounts the data partition for reading and writing; every write reaches the disk within a second. Checks it
/// first with the image's /bin/e2fsck. Returns a sentence about safe repairs, or about a new file system when
/// repair was impossible; otherwise an empty one. The error: the disk cannot be checked, or takes no file
/// system. A slow disk takes long: `meanwhile` is called several times a second.
[[nodiscard]] std::expected<std::string, std::string>
mount_data(const std::string& device, const std::string& folder, const std::function<void()>& meanwhile);

/// In the image: the empty data partition as first written to the disk.
inline constexpr const char* empty_data_file = "/etc/tappet/data";
/// Returns the blocks of a file system that are not empty, each after its number.
[[nodiscard]] std::string numbered_blocks(std::string_view file_system);

/// Writes to the disk itself before it returns. `how`: flags of open(), in addition to writing.
[[nodiscard]] init::Done write_through(const std::string& path, int how, std::string_view bytes);

} // namespace tappet::box
