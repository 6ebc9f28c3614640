// The host's carpet loom as a program of its own: its arguments and its output.
#pragma once

#include "tests/toolchain/folder.hpp"
#include "tests/toolchain/program.hpp"

#include <string>
#include <vector>

namespace tappet::carpet {

inline Ended run_loom(const std::vector<std::string>& words) {
    std::string line = LOOM_PROGRAM;
    for (const std::string& word : words) line += " '" + word + "'";
    return run_line(line);
}

/// The file is removed at the end of the test program.
inline std::string temporary_file(const std::string& name) {
    static const test::Folder folder;
    return folder / name;
}

/// Returns a JSON text without one numeric field.
inline std::string without_field(std::string text, const std::string& name) {
    const auto begin = text.find("\"" + name + "\"");
    if (begin != std::string::npos) text.erase(begin, text.find(',', begin) - begin);
    return text;
}

} // namespace tappet::carpet
