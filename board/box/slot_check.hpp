// SPDX-License-Identifier: Apache-2.0
// Checks that the slots still hold what was written, and boot it: a disk may corrupt data that nobody
// changes.
#pragma once

#include "board/box/slots.hpp"

#include <string>

#include <sys/types.h>

namespace tappet::box {

/// Result of the check before the machine arms: the loader may run this slot because a start of the other one
/// was interrupted. The other one is then given up, or runs at the next boot, which must follow at once.
struct Verdict {
    std::string said{}; ///< empty: no such case
    bool starts_anew = false;
};
[[nodiscard]] Verdict judge_fallback(Slots& slots);

/// After the machine has armed, without a trial: compares both slots with their checksums and ends the start.
class SlotCheck {
public:
    /// Starts a child that reads both slots in the machine's idle time.
    [[nodiscard]] init::Done begin(const Slots& slots);
    /// Called at the end of a child. When the running slot is corrupt and the other is intact, gives up the
    /// running one, so that the next start uses the other. Returns a sentence; an empty one when it was
    /// another child.
    [[nodiscard]] std::string end(pid_t pid, int code, Slots& slots);

private:
    pid_t child_ = -1;
};

} // namespace tappet::box
