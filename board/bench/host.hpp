// SPDX-License-Identifier: Apache-2.0
// The guest's side of its ports to the host.
#pragma once

#include "board/init/system.hpp"

#include <string>
#include <string_view>

namespace tappet::bench {

// What the host reads: one line per fact, written at once, so that a bench that hangs still tells how far it
// got.
class Results {
public:
    void open(int descriptor) { descriptor_ = descriptor; }

    void line(const std::string& text) { write_all(text + "\n"); }

    void write_all(std::string_view bytes);

private:
    int descriptor_ = -1;
};

extern Results results;

// The guest cannot go on: the host must learn why, and on the kernel's console too if no port is up yet.
[[noreturn]] void give_up(const std::string& reason);
// The same, unless it was done.
void must(const init::Done& done);

/// The port of this name to the host, opened; waits for it to appear.
int open_port(const std::string& wanted);

} // namespace tappet::bench
