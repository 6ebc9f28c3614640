// The program as a function of a command line and its output streams; main and the tests call it.
#pragma once

#include "toolchain/tools/browser/commands.hpp"

namespace tappet::browser {

/// How the program was called, and its access to the terminal.
struct Surroundings {
    std::ostream& out;
    std::ostream& errors;
    bool screen = false; ///< the watch view may draw
    bool interactive =
        false; ///< without a command there is a prompt; otherwise lines come from standard input
    std::string history_file{};
    volatile std::sig_atomic_t* signal = nullptr; ///< the last signal; reset to 0 before each typed line
};

/// Returns the exit code, as usage() lists them.
[[nodiscard]] int run_program(std::span<const std::string> words, Surroundings& surroundings);

} // namespace tappet::browser
