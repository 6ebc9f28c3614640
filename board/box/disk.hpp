// SPDX-License-Identifier: Apache-2.0
// The box's disk: the data partition, and the two slots of which one is running, perhaps on trial.
#pragma once

#include "board/init/boot_state.hpp"
#include "board/init/system.hpp"

#include <array>
#include <expected>
#include <string>

namespace tappet::box {

inline constexpr const char* data_partition = "tappet-data";
inline constexpr const char* slot_partitions[] = {"tappet-a", "tappet-b"};

/// "/dev/nvme0n1p4", by the partition's name in the disk's table. The error: none is there (yet), or two
/// disks have one.
[[nodiscard]] std::expected<std::string, std::string> find_partition(const std::string& name);

/// Read and written, every write followed to the disk within a second.
[[nodiscard]] init::Done mount_data(const std::string& device, const std::string& folder);

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

    /// A kernel image into the slot that is not in use, read back from the disk; then, last, on trial at the
    /// next boot. The error, also when there is a trial: that must end first.
    [[nodiscard]] init::Done install(std::string_view kernel);

private:
    static constexpr std::size_t none = 2;
    struct Slot {
        std::string device{};
        init::BootState state{}; ///< of revision 0, failed, when it cannot be read
    };
    std::array<Slot, 2> slots_{};
    std::size_t trial_ = none;
    std::uint32_t revision_ = 0;
};

} // namespace tappet::box
