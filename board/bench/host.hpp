// SPDX-License-Identifier: Apache-2.0
// The guest's ports to the host.
#pragma once

#include "board/init/system.hpp"

#include <string>
#include <string_view>

namespace tappet::bench {

// Output for the host: one line per fact, written at once, so that even a bench that hangs shows its
// progress.
class Results {
public:
    void open(int descriptor) { descriptor_ = descriptor; }

    void line(const std::string& text) { write_all(text + "\n"); }

    void write_all(std::string_view bytes);

private:
    int descriptor_ = -1;
};

extern Results results;

// Stops the guest: tells the host why, and also the kernel's console if no port is open yet.
[[noreturn]] void give_up(const std::string& reason);
// Does the same when `done` is an error.
void must(const init::Done& done);

/// Opens the port of this name to the host; waits until it appears.
int open_port(const std::string& wanted);

} // namespace tappet::bench
