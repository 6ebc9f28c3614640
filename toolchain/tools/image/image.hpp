// SPDX-License-Identifier: Apache-2.0
// What is flashed onto a box, from a firmware: the board's and the binding's tables say the rest.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace tappet::image {

struct Request {
    std::filesystem::path firmware{}; ///< stripped; asked for its board by --board
    std::filesystem::path init{};     ///< the box's PID 1
    std::filesystem::path plant{};    ///< of a test board: the other end of its wires; empty: none
    std::string plant_words{};        ///< its options
    std::filesystem::path kernel{};   ///< ci/setup's: vmlinuz, release, lib/modules
    std::filesystem::path folder{};   ///< where everything goes
    /// Of write_keys(); empty: the box takes no updates, and nothing is signed. One without `secret`: sign()
    /// does it where that is.
    std::filesystem::path keys{};
    std::filesystem::path next_keys{}; ///< which the box's next updates are signed with; empty: the same
    std::uint32_t least = 1;           ///< version that a box must have to be updated to this one
    std::uint32_t version = 1;
    std::uint16_t watchdog_s = 30; ///< armed by the loader; 0: none, for a box without one
};

struct Written {
    std::filesystem::path disk{};
    std::filesystem::path update{}; ///< the same kernel signed, for a stick; empty without keys
    std::filesystem::path bill{};   ///< what is inside, as CycloneDX
    std::filesystem::path
        kernel{}; ///< the unified kernel image of a slot: kernel, root file system, command line
    std::filesystem::path root{};   ///< its root file system, packed, and
    std::string command_line{};     ///< for a boot without the disk
    std::uint64_t kernel_bytes = 0; ///< of the kernel alone
    std::uint64_t root_bytes = 0;
    std::uint64_t slot_bytes = 0;
    std::size_t modules = 0;
};

/// Bit by bit the same from the same parts. What is wrong is thrown: a Fault, or a bench::BenchError.
Written write_image(const Request& request);

/// Signs what write_image() left unsigned in a folder: loader, kernel, disk and update. Needs that folder and
/// the keys, no network and no sources.
void sign(const std::filesystem::path& folder, const std::filesystem::path& keys);

} // namespace tappet::image
