// SPDX-License-Identifier: Apache-2.0
// The two slots of a box's disk; one is running, perhaps on trial.
//
// Every start of a version is a trial by the loader's rule, see init::SlotState. A proven version is set to
// `installed` again after its start, so that an interrupted start leads to the other slot. Meanwhile the
// other slot is `good`, so the loader can use it as often as needed. One loader file is written only while
// the other one boots a complete version.
#pragma once

#include "board/box/slot.hpp"
#include "board/init/system.hpp"

#include <array>
#include <expected>
#include <string>
#include <string_view>

namespace tappet::box {

inline constexpr const char* slot_partitions[] = {"tappet-a", "tappet-b"};

/// The slots by the loader's files and records. One runs, perhaps on trial; the other takes a new version.
class Slots {
public:
    /// Reads the slots. The error: a slot that cannot be read; the other is read all the same.
    [[nodiscard]] init::Done look();

    [[nodiscard]] const Slot& running() const { return slots_[running_]; }
    [[nodiscard]] const Slot& other() const { return slots_[1 - running_]; }
    [[nodiscard]] bool on_trial() const { return running().is_on_trial(); }
    /// Ends the trial with success. The version stays even if this is interrupted.
    [[nodiscard]] init::Done end_trial();
    /// Keeps the trial for the next boot, at an orderly end of the box.
    [[nodiscard]] init::Done keep_trial();

    /// Completes the start of the running version, without a trial. The next start is a trial again if the
    /// other slot could take over. Rewrites a torn loader file of the other slot.
    [[nodiscard]] init::Done end_start(bool other_is_whole);
    /// After is_fallback(): checks the other slot and writes the decision to its record; `proven`: it runs at
    /// the next boot. The error: the record cannot be written, so the next boot finds the same state.
    [[nodiscard]] init::Done judge_other();

    /// Writes a kernel image and its update's header into the unused slot, which is emptied first and cannot
    /// boot meanwhile. Reads it back from the disk, and finally puts it on trial at the next boot. The error
    /// includes an active trial, which must end first.
    [[nodiscard]] init::Done install(std::string_view kernel, std::string_view header);
    /// Puts the other slot's version on trial at the next boot. The error: it failed, or as in install().
    [[nodiscard]] init::Done roll_back();
    /// Gives up the running, corrupt version: it does not boot again, and its slot takes the next version.
    /// From now on the other slot counts as the running one.
    [[nodiscard]] init::Done give_up_running();

private:
    /// Checks that there is another slot. The error: there is none, or a trial is active.
    [[nodiscard]] init::Done need_other() const;
    /// While the other slot still boots: makes the running one boot from now on, whatever happens to it.
    [[nodiscard]] init::Done rely_on_running();
    [[nodiscard]] init::Done boot_other_next();

    std::array<Slot, 2> slots_{};
    std::size_t running_ = 0;
};

/// Returns whether its kernel differs from its header's checksum, or cannot be read. False when the header
/// has no checksum.
[[nodiscard]] bool is_harmed(const Slot& slot);

} // namespace tappet::box
