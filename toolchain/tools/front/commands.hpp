// The words of the front door as one table: help, completion and what is refused follow from it.
#pragma once

#include "toolchain/command_line.hpp"

#include <string>
#include <vector>

namespace tappet::front {

using Words = std::vector<std::string>;

/// What stands after a command.
struct Given {
    CommandLine line{}; ///< views of `words`; empty where the command passes everything on
    Words words{};
    Words behind{}; ///< after "--": they go as they are to the program that the command starts
};

struct Command {
    std::string_view name;
    std::string_view takes; ///< its words, as they are printed
    std::string_view help;
    std::span<const Option> options{};
    Others others = Others::refused;
    std::span<const Option> kinds{}; ///< of its words, if they are limited
    bool passes_on = false;          ///< it is somebody else's command line
    int (*run)(const Given&) = nullptr;
};

/// For a shell: what may stand in place of the last word, which is begun. Not real-time; it looks into the
/// folder's CMakeLists.txt. Empty: file names, or whatever the shell thinks of.
[[nodiscard]] Words completions(std::span<const Command> commands, const Words& words);

} // namespace tappet::front
