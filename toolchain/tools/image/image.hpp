// SPDX-License-Identifier: Apache-2.0
// Builds the files to flash onto a box from a firmware; the tables of its board and binding supply the rest.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace tappet::image {

struct Request {
    std::filesystem::path firmware{}; ///< stripped; --board prints its board
    std::filesystem::path init{};     ///< the box's PID 1
    std::filesystem::path plant{};    ///< for a test board: the other end of its wires; empty: none
    std::string plant_words{};        ///< its options
    std::filesystem::path kernel{};   ///< ci/setup's: vmlinuz, release, lib/modules
    std::filesystem::path folder{};   ///< for all output
    /// From write_keys(); empty: the box takes no updates, and nothing is signed. Without `secret`, sign()
    /// signs later where that file is.
    std::filesystem::path keys{};
    std::filesystem::path next_keys{}; ///< for signing the box's next updates; empty: the same
    std::uint32_t least = 1;           ///< version that a box needs for an update to this one
    std::uint32_t version = 1;
    std::uint16_t watchdog_s = 30; ///< armed by the loader; 0: none, for a box without a watchdog
};

struct Written {
    std::filesystem::path disk{};
    std::filesystem::path update{}; ///< the same kernel signed, for a USB stick; empty without keys
    std::filesystem::path bill{};   ///< the contents, as CycloneDX
    std::filesystem::path
        kernel{}; ///< the unified kernel image of a slot: kernel, root file system, command line
    std::filesystem::path root{};   ///< its root file system, packed
    std::string command_line{};     ///< for a boot without the disk
    std::uint64_t kernel_bytes = 0; ///< of the kernel alone
    std::uint64_t root_bytes = 0;
    std::uint64_t slot_bytes = 0;
    std::size_t modules = 0;
};

/// The same input gives the same image, bit by bit. Throws a Fault, or a bench::BenchError.
Written write_image(const Request& request);

/// Signs the unsigned output of write_image() in a folder: loader, kernel, disk and update. Needs that folder
/// and the keys, but no network and no sources.
void sign(const std::filesystem::path& folder, const std::filesystem::path& keys);

} // namespace tappet::image
