// The prompt: lines edited with completion and history, each run as if it were given on a command line.
#pragma once

#include "toolchain/tools/browser/machines.hpp"

#include <csignal>
#include <functional>
#include <string>

namespace tappet::browser {

/// What became of a typed line.
enum class Next { prompt, end };

class Shell {
public:
    /// Runs a line; the sentences of failures are told by it.
    using Run = std::function<Next(const std::string& line)>;

    /// `history_file`: kept over sessions; empty for none. `signal`: the last that came; an interrupt gives
    /// the typed line up, any other ends the prompt.
    Shell(Machines& machines, std::string history_file, const volatile std::sig_atomic_t* signal, Run run)
        : machines_{machines},
          history_file_{std::move(history_file)},
          signal_{signal},
          run_{std::move(run)} {}

    /// Until "quit" or the end of the input.
    void run();

private:
    Machines& machines_;
    std::string history_file_;
    const volatile std::sig_atomic_t* signal_;
    Run run_;
};

} // namespace tappet::browser
