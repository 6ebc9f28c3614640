// SPDX-License-Identifier: Apache-2.0
// The box's disk as a file: a GUID partition table, the loader's partition, two slots and one for data.
#pragma once

#include "board/init/boot_state.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tappet::image {

inline constexpr std::uint64_t sector_bytes = 512;

struct Partition {
    std::string name{};  ///< in the table: what the box's init looks for
    std::string label{}; ///< of the file system: what the loader looks for
    std::string type{};  ///< as sgdisk takes it
    std::uint64_t first_sector = 0;
    std::uint64_t sectors = 0;

    [[nodiscard]] std::uint64_t bytes() const { return sectors * sector_bytes; }
};

/// The loader's, the slots, data: the same on every box.
[[nodiscard]] const std::vector<Partition>& partitions();
[[nodiscard]] std::uint64_t disk_bytes();

inline constexpr const char* file_in_slot = "tappet.efi";
/// As the loader names it.
[[nodiscard]] std::string kernel_of(const Partition& slot);

/// What goes onto a disk beside its file systems.
struct DiskParts {
    std::filesystem::path loader{};
    std::filesystem::path kernel{};                    ///< the unified image of both slots
    std::string header{};                              ///< of its update, to tell what it is
    std::vector<std::filesystem::path> certificates{}; ///< for the box's setup, on the loader's partition
    std::uint16_t watchdog_s = 0;
};

/// The file system of the data partition, without a file.
void write_data(const std::filesystem::path& file);
/// Writes the whole disk; of its slots the first is the newer. The same in makes the same out, bit by bit.
void write_disk(const std::filesystem::path& disk, const DiskParts& parts, const std::filesystem::path& work);

} // namespace tappet::image
