// SPDX-License-Identifier: Apache-2.0
#include "toolchain/tools/image/slots.hpp"

#include "board/box/slot.hpp"
#include "board/box/update.hpp"
#include "toolchain/tools/bench/folders.hpp"
#include "toolchain/tools/image/tool.hpp"

#include <algorithm>

namespace tappet::image {

namespace fs = std::filesystem;

namespace {

std::string place(const fs::path& disk, const Partition& slot) {
    return disk.string() + "@@" + std::to_string(slot.first_sector * sector_bytes);
}

void read(const fs::path& disk, const Partition& slot, std::string_view name, const fs::path& to) {
    run_tool({"mcopy", "-n", "-i", place(disk, slot), "::" + std::string{name}, to.string()});
}
void write(const fs::path& disk, const Partition& slot, const fs::path& from, std::string_view name) {
    run_tool({"mcopy", "-D", "o", "-i", place(disk, slot), from.string(), "::" + std::string{name}});
}

} // namespace

std::expected<init::BootState, std::string> read_slot(const fs::path& disk, const Partition& slot) {
    const bench::WorkFolder work("tappet-slot");
    read(disk, slot, init::boot_state_file, work / "state");
    return init::decode(read_file(work / "state"));
}

std::uint32_t install(const fs::path& disk, const fs::path& kernel) {
    const bench::WorkFolder work("tappet-slot");
    const Partition& a = partitions()[1];
    const Partition& b = partitions()[2];
    const auto rank = [&](const Partition& slot) -> std::uint32_t {
        const auto state = read_slot(disk, slot);
        return state && state->state != init::SlotState::failed ? state->revision : 0;
    };
    const std::uint32_t of_a = rank(a), of_b = rank(b);
    if (of_a == 0 && of_b == 0) throw Fault(disk.string() + " has no slot that could boot; flash it anew");
    const Partition& slot = of_a < of_b ? a : b;
    const Partition& other = of_a < of_b ? b : a;
    const auto write_text = [&](const Partition& to, std::string_view name, const std::string& text) {
        write_file(work / "text", text);
        write(disk, to, work / "text", name);
    };
    init::BootState state = read_slot(disk, other).value();
    state.state = init::SlotState::good; // it boots whatever happens to the new version
    write_text(other, init::boot_state_file, init::encode(state));
    write(disk, slot, kernel, file_in_slot);
    read(disk, slot, file_in_slot, work / "back");
    if (read_file(work / "back") != read_file(kernel))
        throw Fault(disk.string() + " does not keep what was written to " + slot.name +
                    "; take another disk");
    // Deletes the slot's header, which identifies a kernel: only an update brings one.
    run_tool({"mdel", "-i", place(disk, slot), "::" + std::string{box::header_file}}, Trouble::is_told);
    write_text(slot, box::record_file, box::encode(box::Record{}));
    state.kernel = kernel_of(slot);
    state.revision = std::max(of_a, of_b) + 1;
    state.state = init::SlotState::installed;
    write_text(slot, init::boot_state_file, init::encode(state));
    return state.revision;
}

} // namespace tappet::image
