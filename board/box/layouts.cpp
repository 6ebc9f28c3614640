// SPDX-License-Identifier: Apache-2.0
// Folders named after layouts, and a file that names the last one.
#include "board/box/layouts.hpp"

#include "board/box/disk.hpp"

#include <cstdio>

#include <fcntl.h>

namespace tappet::box {

namespace {
const std::string layout_file = std::string{data_folder} + "/layout";
}

std::string properties_folder(const std::string& layout) {
    return std::string{data_folder} + "/properties-" + layout;
}

std::string last_layout() { return init::read_line(layout_file); }

init::Done note_layout(const std::string& layout) {
    if (last_layout() == layout) return {};
    const std::string part = layout_file + ".new";
    if (auto kept = write_through(part, O_CREAT | O_TRUNC, layout + "\n"); !kept) return kept;
    return std::rename(part.c_str(), layout_file.c_str()) == 0 ? init::Done{}
                                                               : init::failed("rename " + part);
}

} // namespace tappet::box
