// The commands of `tappet` as one table: it defines help, completion and refusals.
#pragma once

#include "toolchain/command_line.hpp"

#include <string>
#include <vector>

namespace tappet::front {

using Words = std::vector<std::string>;

/// The words after a command.
struct Given {
    CommandLine line{}; ///< views of `words`; empty if the command passes everything on
    Words words{};
    Words behind{}; ///< after "--": passed unchanged to the program that the command starts
};

struct Command {
    std::string_view name;
    std::string_view takes; ///< its words, as printed
    std::string_view help;
    std::span<const Option> options{};
    Others others = Others::refused;
    std::span<const Option> kinds{}; ///< its allowed words, if they are limited
    bool passes_on = false;          ///< the command line belongs to another program
    int (*run)(const Given&) = nullptr;
};

/// Returns candidates for the last, unfinished word, for a shell. Reads the folder's CMakeLists.txt. Empty:
/// file names, or the shell's default. Not real-time.
[[nodiscard]] Words completions(std::span<const Command> commands, const Words& words);

} // namespace tappet::front
