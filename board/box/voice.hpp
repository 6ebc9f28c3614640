// SPDX-License-Identifier: Apache-2.0
// What init and firmware say, on every console of the board.
#pragma once

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
    /// As it comes. A console that takes nothing more (Ctrl-S, a slow line) loses it: nobody waits for it.
    void pass_on(std::string_view text) const;

private:
    std::vector<int> consoles_;
};

/// Since the kernel began.
[[nodiscard]] double uptime_s();

} // namespace tappet::box
