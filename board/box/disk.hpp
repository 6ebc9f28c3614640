// SPDX-License-Identifier: Apache-2.0
// The box's disk: the data partition, and the two slots of which one is running, perhaps on trial.
#pragma once

#include "board/init/boot_state.hpp"
#include "board/init/system.hpp"

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

/// The slot that the loader put on trial for this boot; none when it booted a good one.
class Trial {
public:
    /// Looks into both slots. The error: a slot that cannot be read.
    [[nodiscard]] init::Done look();

    [[nodiscard]] bool is_on() const { return !device_.empty(); }
    [[nodiscard]] std::uint32_t revision() const { return state_.revision; }
    /// Ends it: good, or installed to have it once more at the next boot. In place: when the power fails in
    /// between, the loader finds the sum wrong and boots the other slot.
    [[nodiscard]] init::Done end(init::SlotState state);

private:
    std::string device_;
    init::BootState state_{};
};

} // namespace tappet::box
