// SPDX-License-Identifier: Apache-2.0
// The two slots of a box's disk, of which one is running, perhaps on trial.
//
// Every start of a version is a trial by the loader's rule, see init::SlotState: one that has proven itself
// is `installed` again when it has started, so that a start that does not come so far ends in the other slot.
// The other slot is `good` meanwhile, which the loader takes as often as it must. Of two files of the loader
// one is written only while the other one boots a whole version.
#pragma once

#include "board/box/slot.hpp"
#include "board/init/system.hpp"

#include <array>
#include <expected>
#include <string>
#include <string_view>

namespace tappet::box {

inline constexpr const char* slot_partitions[] = {"tappet-a", "tappet-b"};

/// As the loader's files and the records say. One runs, perhaps on trial; the other takes the next version.
class Slots {
public:
    /// The error: a slot that cannot be read. The other is looked at all the same.
    [[nodiscard]] init::Done look();

    [[nodiscard]] const Slot& running() const { return slots_[running_]; }
    [[nodiscard]] const Slot& other() const { return slots_[1 - running_]; }
    [[nodiscard]] bool on_trial() const { return running().is_on_trial(); }
    /// It has done what was asked for. Whatever cuts this short, the version stays.
    [[nodiscard]] init::Done end_trial();
    /// The box ends in order: what has not come to its end begins once more at the next boot.
    [[nodiscard]] init::Done keep_trial();

    /// The version that runs, not on trial, has started. The next start is a trial again if the other slot
    /// could take over. A file of the loader's that is torn there is written anew.
    [[nodiscard]] init::Done end_start(bool other_is_whole);
    /// After is_fallback(): reads what lies in the other slot. What is decided is its record; `proven`: it
    /// runs at the next boot. The error: that cannot be written, and is the same again at the next boot.
    [[nodiscard]] init::Done judge_other();

    /// A kernel image and the header of its update into the slot that is not in use, which is emptied first
    /// and boots nothing meanwhile; read back from the disk; then, last, on trial at the next boot. The
    /// error, also when there is a trial: that must end first.
    [[nodiscard]] init::Done install(std::string_view kernel, std::string_view header);
    /// What the other slot holds goes on trial at the next boot. The error: it failed, or see install().
    [[nodiscard]] init::Done roll_back();
    /// What runs is harmed: it boots no more, and takes the next version. From here on the other one counts
    /// as the one that runs.
    [[nodiscard]] init::Done give_up_running();

private:
    /// That there is a slot beside the one that runs. The error: there is not, or there is a trial.
    [[nodiscard]] init::Done need_other() const;
    /// While the other slot still boots: the one that runs boots from here on whatever becomes of that.
    [[nodiscard]] init::Done rely_on_running();
    [[nodiscard]] init::Done boot_other_next();

    std::array<Slot, 2> slots_{};
    std::size_t running_ = 0;
};

/// Whether its kernel is another than its header says, or cannot be read. One whose header says nothing is
/// not.
[[nodiscard]] bool is_harmed(const Slot& slot);

} // namespace tappet::box
