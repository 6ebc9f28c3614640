// SPDX-License-Identifier: Apache-2.0
// The box's disk: its partitions by name, and the one with the data.
#pragma once

#include "board/init/system.hpp"

#include <expected>
#include <functional>
#include <string>

namespace tappet::box {

inline constexpr const char* data_partition = "tappet-data";

/// "/dev/nvme0n1p4", by the partition's name in the disk's table. The error: none is there (yet), or two
/// disks have one.
[[nodiscard]] std::expected<std::string, std::string> find_partition(const std::string& name);

/// Read and written, every write followed to the disk within a second. Checked before by the image's
/// /bin/e2fsck. What that mended without a guess, or that it could not and the file system was made anew,
/// as a sentence, else nothing. The error: the disk takes none. A slow disk takes its time: `meanwhile` is
/// called several times a second.
[[nodiscard]] std::expected<std::string, std::string>
mount_data(const std::string& device, const std::string& folder, const std::function<void()>& meanwhile);

/// In the image: the data partition as its disk's writer made it, without a file.
inline constexpr const char* empty_data_file = "/etc/tappet/data";
/// A file system's blocks that hold something, each behind its number.
[[nodiscard]] std::string numbered_blocks(std::string_view file_system);

/// To the disk itself before it returns. `how`: of open(), beside writing.
[[nodiscard]] init::Done write_through(const std::string& path, int how, std::string_view bytes);

} // namespace tappet::box
