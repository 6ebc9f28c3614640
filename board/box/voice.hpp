// SPDX-License-Identifier: Apache-2.0
// What init and firmware say, on every console of the board.
#pragma once

#include "board/init/system.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace tappet::box {

class Voice {
public:
    /// "tty0", "ttyS0,115200". Of one that is not there nothing is heard.
    void open(const std::string& console);
    /// One line with the time since the power came.
    void say(std::string_view sentence) const;
    /// Writes to that file what was said before and what is said from now on. A process of its own writes it
    /// through to the disk, so that nobody waits for a disk that does not answer. Such a disk loses what does
    /// not fit the socket to that process. The error: a sentence.
    [[nodiscard]] init::Done keep_in(const std::string& file);
    /// The file's disk is about to go: what was said is there, or is given up after a second.
    void let_go();
    /// As it comes. A console that takes nothing more (Ctrl-S, a slow line) loses it: nobody waits for it.
    void pass_on(std::string_view text) const;

private:
    void keep(std::string_view line) const;

    std::vector<int> consoles_;
    int file_ = -1; ///< a socket to the writer
    pid_t writer_ = -1;
    mutable std::string said_before_{}; ///< while there is no file
};

/// Since the kernel began.
[[nodiscard]] double uptime_s();
/// "1.250 s"
[[nodiscard]] std::string text_of_seconds(double seconds);

} // namespace tappet::box
