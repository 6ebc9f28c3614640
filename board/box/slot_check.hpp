// SPDX-License-Identifier: Apache-2.0
// Whether the slots still hold what was written there: a disk may lose a byte that nobody touches.
#pragma once

#include "board/box/disk.hpp"

#include <sys/types.h>

namespace tappet::box {

class SlotCheck {
public:
    /// A child reads both, with what time the machine leaves. Not during a trial, whose end is written to
    /// one.
    void begin(const Slots& slots);
    /// When that child has ended. A slot that runs and is harmed is given up if the other is whole: the next
    /// start takes that. A sentence, or nothing to say.
    [[nodiscard]] std::string end(pid_t pid, int code, Slots& slots);

private:
    pid_t child_ = -1;
};

} // namespace tappet::box
