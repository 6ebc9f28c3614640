// SPDX-License-Identifier: Apache-2.0
// Which files of a kernel a board's modules need, and the table that the box's init reads instead of udev's.
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

/// `rows` are the board's: a name, and parameters after it; `later` are those that come when the machine has
/// armed. `tree` is <kernel>/lib/modules/<release>, with
/// depmod's tables. What the kernel has built in is left out. A fault: a name that the kernel does not have.
KernelModules choose_modules(const std::vector<std::string>& rows, const std::vector<std::string>& later,
                             const std::filesystem::path& tree);

} // namespace tappet::image
