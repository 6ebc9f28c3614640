// The prompt: edits lines with completion and history, and runs each like a command line.
#pragma once

#include "toolchain/tools/browser/machines.hpp"

#include <functional>
#include <string>

namespace tappet::browser {

/// The result of a typed line.
enum class Next { prompt, end };

class Shell {
public:
    /// Runs a line, and reports its failures.
    using Run = std::function<Next(const std::string& line)>;

    /// `history_file`: kept across sessions; empty for none. `signal`: the last signal; an interrupt discards
    /// the typed line, any other ends the prompt.
    Shell(Machines& machines, std::string history_file, const StopFlag* signal, Run run)
        : machines_{machines},
          history_file_{std::move(history_file)},
          signal_{signal},
          run_{std::move(run)} {}

    /// Runs until "quit" or the end of the input.
    void run();

private:
    Machines& machines_;
    std::string history_file_;
    const StopFlag* signal_;
    Run run_;
};

} // namespace tappet::browser
