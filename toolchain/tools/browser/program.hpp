// The program as a function: a command line, and where its words go; main and the tests call it.
#pragma once

#include "toolchain/tools/browser/commands.hpp"

namespace tappet::browser {

/// How the program was called, and what it may use of the terminal.
struct Surroundings {
    std::ostream& out;
    std::ostream& errors;
    bool screen = false; ///< the watch view may draw
    bool interactive =
        false; ///< without a command there is a prompt; else lines are read from standard input
    std::string history_file{};
    volatile std::sig_atomic_t* signal = nullptr; ///< the last that came; 0 again before each typed line
};

/// The exit code, as usage() lists them.
[[nodiscard]] int run_program(std::span<const std::string> words, Surroundings& surroundings);

} // namespace tappet::browser
