// SPDX-License-Identifier: Apache-2.0
// Whether the slots still hold what was written there, and boot it: a disk may lose a byte that nobody
// touches.
#pragma once

#include "board/box/slots.hpp"

#include <string>

#include <sys/types.h>

namespace tappet::box {

/// Before the machine arms: the loader may have taken the slot that runs because a start of the other one did
/// not come to its end. Then that one is given up, or runs at the next boot, which is to come at once.
struct Verdict {
    std::string said{}; ///< empty: nothing of that kind
    bool starts_anew = false;
};
[[nodiscard]] Verdict judge_fallback(Slots& slots);

/// When it has armed, and is not on trial: both are compared with their sums, and the start is over.
class SlotCheck {
public:
    /// A child reads both, with what time the machine leaves.
    [[nodiscard]] init::Done begin(const Slots& slots);
    /// When that child has ended. A slot that runs and is harmed is given up if the other is whole: the next
    /// start takes that. A sentence, or nothing: it was another child.
    [[nodiscard]] std::string end(pid_t pid, int code, Slots& slots);

private:
    pid_t child_ = -1;
};

} // namespace tappet::box
