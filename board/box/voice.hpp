// SPDX-License-Identifier: Apache-2.0
// The messages of init and firmware, on every console of the board.
#pragma once

#include "board/init/system.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace tappet::box {

class Voice {
public:
    /// Opens a console: "tty0", "ttyS0,115200". Ignores one that does not exist.
    void open(const std::string& console);
    /// Writes one line with the time since power-on.
    void say(std::string_view sentence) const;
    /// Writes earlier and later messages to that file. A separate process writes them through to the disk, so
    /// that a disk that does not respond blocks nobody; messages that exceed the socket to that process are
    /// then lost. The error is a sentence.
    [[nodiscard]] init::Done keep_in(const std::string& file);
    /// Stops writing to the file before its disk is unmounted; waits up to a second for pending messages.
    void let_go();
    /// Passes the text on unchanged. A blocked console (Ctrl-S, a slow line) loses it: nobody waits for it.
    void pass_on(std::string_view text) const;

private:
    void keep(std::string_view line) const;

    std::vector<int> consoles_;
    int file_ = -1; ///< a socket to the writer
    pid_t writer_ = -1;
    mutable std::string said_before_{}; ///< until there is a file
};

/// Returns the time since the kernel started.
[[nodiscard]] double uptime_s();
/// Returns text such as "1.250 s".
[[nodiscard]] std::string text_of_seconds(double seconds);

} // namespace tappet::box
