// SPDX-License-Identifier: Apache-2.0
// Compares kernels with the checksums in their headers, and acts on the result.
#include "board/box/slot_check.hpp"

#include "board/box/update.hpp"

#include <csignal>

#include <sched.h>
#include <sys/mount.h>
#include <sys/prctl.h>
#include <unistd.h>

namespace tappet::box {

namespace {

constexpr int running_is_harmed = 1, other_is_harmed = 2, not_looked = 4;

std::string version_in(const Slot& slot) {
    const std::uint32_t version = manifest_of(slot.header).version;
    return version == 0 ? "the version in the other slot" : "version " + std::to_string(version);
}

/// Returns whether it can boot, or could if the loader's file were not torn.
bool is_of_use(const Slot& slot) {
    return slot.state.state != init::SlotState::failed || slot.record.standing == Standing::proven;
}

const char* found(int code, bool gives_up) {
    if (code >= not_looked) return "the slots were not compared with their checksums";
    if (code == 0) return "both slots hold what was written there: the start is over";
    if (code == other_is_harmed)
        return "the kernel in the other slot is not what was written there: that slot is unusable; install "
               "an update";
    return gives_up ? "the kernel in the slot that runs is not what was written there: a byte changed on the "
                      "disk; from the next start on the other slot is used"
                    : "the kernel in the slot that runs is not what was written there, and the other slot is "
                      "unusable; install an update before the box is switched off";
}

} // namespace

Verdict judge_fallback(Slots& slots) {
    if (!is_fallback(slots.running(), slots.other())) return {};
    const std::string begin = "the last start of " + version_in(slots.other()) +
                              " in the other slot did not finish, ",
                      end = ": it is given up, and the running version stays; install an update";
    if (const auto judged = slots.judge_other(); !judged)
        return {begin + "and it cannot be judged: " + judged.error()};
    if (slots.other().record.standing == Standing::harmed)
        return {begin + "and its kernel is not what was written there, a byte changed on the disk" + end};
    if (slots.other().record.standing == Standing::silent)
        return {begin + "like those before it, though its kernel is intact" + end};
    return {begin + "by a power cut, or it hung; its kernel is intact: the box goes back to it", true};
}

init::Done SlotCheck::begin(const Slots& slots) {
    if (child_ > 0) return {}; // it is already running
    child_ = ::fork();
    if (child_ < 0) return init::failed("the slots cannot be compared with their checksums");
    if (child_ != 0) return {};
    sched_param idle{};
    ::sched_setscheduler(0, SCHED_IDLE, &idle);
    // Its mounts are private, and end with it.
    if (::unshare(CLONE_NEWNS) != 0 || ::mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0)
        ::_exit(not_looked);
    ::_exit((is_harmed(slots.running()) ? running_is_harmed : 0) +
            (is_of_use(slots.other()) && is_harmed(slots.other()) ? other_is_harmed : 0));
}

std::string SlotCheck::end(pid_t pid, int code, Slots& slots) {
    if (pid != child_) return {};
    child_ = -1;
    const int harm = code < not_looked ? code : 0; // else the child was killed: no result
    const bool gives_up = harm == running_is_harmed && slots.other().is_good();
    const auto done = gives_up ? slots.give_up_running() : slots.end_start((harm & other_is_harmed) == 0);
    return found(code, gives_up) + (done ? "" : "; the result cannot be saved: " + done.error());
}

} // namespace tappet::box
