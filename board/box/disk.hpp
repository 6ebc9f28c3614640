// SPDX-License-Identifier: Apache-2.0
// The box's disk: the data partition, and the two slots of which one is running, perhaps on trial.
#pragma once

#include "board/init/boot_state.hpp"
#include "board/init/system.hpp"

#include <array>
#include <expected>
#include <functional>
#include <string>

namespace tappet::box {

inline constexpr const char* data_partition = "tappet-data";
inline constexpr const char* slot_partitions[] = {"tappet-a", "tappet-b"};

/// "/dev/nvme0n1p4", by the partition's name in the disk's table. The error: none is there (yet), or two
/// disks have one.
[[nodiscard]] std::expected<std::string, std::string> find_partition(const std::string& name);

/// Read and written, every write followed to the disk within a second. Checked before by the image's
/// /bin/e2fsck. What that mended without a guess, or that it could not and the file system was made anew,
/// as a sentence, else nothing. The error: the disk takes none. A slow disk takes its time: `meanwhile` is
/// called several times a second.
[[nodiscard]] std::expected<std::string, std::string>
mount_data(const std::string& device, const std::string& folder, const std::function<void()>& meanwhile);

/// In the image: the data partition as its disk's writer made it, without a file.
inline constexpr const char* empty_data_file = "/etc/tappet/data";
/// A file system's blocks that hold something, each behind its number.
[[nodiscard]] std::string numbered_blocks(std::string_view file_system);

/// To the disk itself before it returns. `how`: of open(), beside writing.
[[nodiscard]] init::Done write_through(const std::string& path, int how, std::string_view bytes);

/// The two slots as the loader's files say. One runs, perhaps on trial; the other takes the next version.
class Slots {
public:
    /// The error: a slot that cannot be read. The other is looked at all the same.
    [[nodiscard]] init::Done look();

    [[nodiscard]] bool on_trial() const { return trial_ != none; }
    /// Of the trial, also when it is over.
    [[nodiscard]] std::uint32_t revision() const { return revision_; }
    /// Ends it: good, or installed to have it once more at the next boot. In place: when the power fails in
    /// between, the loader finds the sum wrong and boots the other slot.
    [[nodiscard]] init::Done end_trial(init::SlotState state);

    /// A kernel image and the header of its update into the slot that is not in use, which is emptied first
    /// and boots nothing meanwhile; read back from the disk; then, last, on trial at the next boot. The
    /// error, also when there is a trial: that must end first.
    [[nodiscard]] init::Done install(std::string_view kernel, std::string_view header);
    /// What the other slot holds goes on trial at the next boot. The error: it failed, or see install().
    [[nodiscard]] init::Done roll_back();

    struct Slot {
        std::string device{};
        init::BootState state{}; ///< of revision 0, failed, when it cannot be read
        std::string header{};    ///< of what lies in it; empty: it was written without
    };
    /// It boots no more, and takes the next version. From here on the other one counts as the one that runs.
    [[nodiscard]] init::Done give_up_running();
    /// That runs, then the other.
    [[nodiscard]] std::array<const Slot*, 2> in_order() const;

private:
    static constexpr std::size_t none = 2;
    /// The slot that does not run, if both are of use. The error: they are not, or there is a trial.
    [[nodiscard]] std::expected<std::size_t, std::string> free_slot() const;
    [[nodiscard]] init::Done put_on_trial(std::size_t slot, std::uint16_t watchdog_s);
    std::array<Slot, 2> slots_{};
    std::size_t trial_ = none;
    std::uint32_t revision_ = 0;
};

/// Whether its kernel is another than its header says. One whose header says nothing is not.
[[nodiscard]] bool is_harmed(const Slots::Slot& slot);

} // namespace tappet::box
