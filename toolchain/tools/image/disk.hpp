// SPDX-License-Identifier: Apache-2.0
// The box's disk as a file: a GUID partition table, the loader's partition, two slots and a data partition.
#pragma once

#include "board/init/boot_state.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tappet::image {

inline constexpr std::uint64_t sector_bytes = 512;

struct Partition {
    std::string name{};  ///< in the table: the box's init searches it
    std::string label{}; ///< of the file system: the loader searches it
    std::string type{};  ///< in sgdisk's notation
    std::uint64_t first_sector = 0;
    std::uint64_t sectors = 0;

    [[nodiscard]] std::uint64_t bytes() const { return sectors * sector_bytes; }
};

/// Returns the loader's partition, the slots, data: the same on every box.
[[nodiscard]] const std::vector<Partition>& partitions();
[[nodiscard]] std::uint64_t disk_bytes();

inline constexpr const char* file_in_slot = "tappet.efi";
/// Returns the kernel's path, as the loader names it.
[[nodiscard]] std::string kernel_of(const Partition& slot);

/// The contents of a disk beside its file systems.
struct DiskParts {
    std::filesystem::path loader{};
    std::filesystem::path kernel{};                    ///< the unified image of both slots
    std::string header{};                              ///< of its update, to identify it
    std::vector<std::filesystem::path> certificates{}; ///< for the firmware setup, on the loader's partition
    std::uint16_t watchdog_s = 0;
};

/// Writes the file system of the data partition, without a file.
void write_data(const std::filesystem::path& file);
/// Writes the whole disk; the first slot is the newer one. The same input gives the same output, bit by bit.
void write_disk(const std::filesystem::path& disk, const DiskParts& parts, const std::filesystem::path& work);

} // namespace tappet::image
