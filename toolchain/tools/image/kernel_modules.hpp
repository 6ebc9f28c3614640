// SPDX-License-Identifier: Apache-2.0
// Finds the kernel files that a board's modules need, and the table that the box's init reads, not udev.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace tappet::image {

struct KernelModules {
    std::string table{};                                  ///< as board/box/modules.hpp describes it
    std::map<std::string, std::filesystem::path> files{}; ///< by name
};

/// `rows` are the board's: a name, and parameters after it. `later` are modules to load once the machine has
/// armed. `tree` is <kernel>/lib/modules/<release>, with depmod's tables. Leaves out built-in modules. Throws
/// a fault for a name that the kernel does not have.
KernelModules choose_modules(const std::vector<std::string>& rows, const std::vector<std::string>& later,
                             const std::filesystem::path& tree);

} // namespace tappet::image
