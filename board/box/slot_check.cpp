// SPDX-License-Identifier: Apache-2.0
// Kernels against the sums in their headers.
#include "board/box/slot_check.hpp"

#include "board/box/update.hpp"

#include <csignal>

#include <sched.h>
#include <sys/mount.h>
#include <sys/prctl.h>
#include <unistd.h>

namespace tappet::box {

namespace {

constexpr int running_is_harmed = 1, other_is_harmed = 2;

} // namespace

void SlotCheck::begin(const Slots& slots) {
    child_ = ::fork();
    if (child_ != 0) return;
    sched_param idle{};
    ::sched_setscheduler(0, SCHED_IDLE, &idle);
    // What it mounts is its own, and goes with it.
    if (::unshare(CLONE_NEWNS) != 0 || ::mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0)
        ::_exit(0);
    const auto [running, other] = slots.in_order();
    const auto harm = [](const Slots::Slot& slot, int code) {
        return slot.state.state != init::SlotState::failed && is_harmed(slot) ? code : 0;
    };
    ::_exit(harm(*running, running_is_harmed) + harm(*other, other_is_harmed));
}

std::string SlotCheck::end(pid_t pid, int code, Slots& slots) {
    if (pid != child_) return {};
    child_ = -1;
    if (code > running_is_harmed + other_is_harmed || code == 0) return {}; // it was ended, or all is well
    if (code == other_is_harmed)
        return "the kernel in the other slot is not what was written there: it is of no use; bring an update";
    if (code != running_is_harmed || slots.in_order()[1]->state.state != init::SlotState::good)
        return "the kernel in the slot that runs is not what was written there, and the other slot is of no "
               "use; bring an update before the box is switched off";
    const auto given_up = slots.give_up_running();
    return "the kernel in the slot that runs is not what was written there: a byte changed on the disk; " +
           (given_up ? std::string{"from the next start on the other slot is used"} : given_up.error());
}

} // namespace tappet::box
