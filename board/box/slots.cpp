// SPDX-License-Identifier: Apache-2.0
// A slot's file system: the loader's file, the record, the header, the kernel.
#include "board/box/slots.hpp"

#include "board/box/disk.hpp"
#include "board/box/update.hpp"

#include <algorithm>
#include <cerrno>

#include <fcntl.h>
#include <sys/mount.h>
#include <unistd.h>

namespace tappet::box {

namespace {

constexpr const char* slot_folder = "/run/slot";
constexpr const char* kernel_file = "tappet.efi";
constexpr std::size_t sector_bytes = 512;

class MountedSlot {
public:
    MountedSlot(const std::string& device, unsigned long flags) {
        init::make_folder(slot_folder);
        is_there_ = ::mount(device.c_str(), slot_folder, "vfat", flags | MS_NOSUID | MS_NODEV | MS_NOEXEC,
                            "codepage=437,iocharset=ascii") == 0;
    }
    ~MountedSlot() {
        const int error = errno;
        if (is_there_) ::umount(slot_folder);
        errno = error;
    }
    MountedSlot(const MountedSlot&) = delete;
    MountedSlot& operator=(const MountedSlot&) = delete;

    [[nodiscard]] bool is_there() const { return is_there_; }
    [[nodiscard]] static std::string file(std::string_view name) {
        return std::string{slot_folder} + "/" + std::string{name};
    }

private:
    bool is_there_ = false;
};

/// Overwrites the file without truncation: each has constant length.
init::Done write_in_place(const Slot& slot, std::string_view file, std::string_view bytes) {
    const MountedSlot mounted{slot.device, 0};
    if (!mounted.is_there()) return init::failed("mount " + slot.device);
    return write_through(MountedSlot::file(file), O_CREAT, bytes);
}

init::Done write(Slot& slot, const init::BootState& state) {
    auto written = write_in_place(slot, init::boot_state_file, init::encode(state));
    if (written) slot.state = state;
    return written;
}

init::Done write(Slot& slot, init::SlotState how) {
    init::BootState state = slot.state;
    state.state = how;
    return write(slot, state);
}

init::Done write(Slot& slot, const Record& record) {
    if (record == slot.record) return {};
    auto written = write_in_place(slot, record_file, encode(record));
    if (written) slot.record = record;
    return written;
}

/// Reads a slot. The error: the loader's file is invalid; the other files are read all the same.
init::Done read(Slot& slot) {
    const MountedSlot mounted{slot.device, MS_RDONLY};
    if (!mounted.is_there()) return init::failed("mount " + slot.device);
    slot.header = init::read_text(MountedSlot::file(header_file));
    slot.record = record_of(init::read_text(MountedSlot::file(record_file)));
    const auto state = init::decode(init::read_text(MountedSlot::file(init::boot_state_file)));
    if (!state)
        return std::unexpected(std::string{init::boot_state_file} + " of " + slot.device + " " +
                               state.error());
    slot.state = *state;
    return {};
}

/// Makes an empty file system, whatever a power cut left of the old one: lost clusters would fill the slot,
/// and a torn table would refuse every version. Its first sector, with the geometry, is kept, because its
/// contents are not stored anywhere else.
init::Done empty_slot(const std::string& device) {
    const int disk = ::open(device.c_str(), O_RDWR | O_EXCL | O_CLOEXEC);
    std::array<unsigned char, sector_bytes> head{};
    bool done = disk >= 0 && ::pread(disk, head.data(), head.size(), 0) == sector_bytes;
    const auto word = [&](std::size_t at) { return head[at] + 256U * head[at + 1]; };
    const std::size_t tables = head[16], table_bytes = word(22) * sector_bytes, root_bytes = word(17) * 32;
    if (done && (word(11) != sector_bytes || tables == 0 || table_bytes == 0)) {
        ::close(disk);
        return std::unexpected(device + " has no file system of ours; flash the box anew");
    }
    std::string area(tables * table_bytes + root_bytes, '\0');
    for (std::size_t i = 0; done && i < tables; ++i)
        area.replace(i * table_bytes, 4, {static_cast<char>(head[21]), '\xff', '\xff', '\xff'});
    done = done && ::pwrite(disk, area.data(), area.size(), word(14) * sector_bytes) == std::ssize(area) &&
           ::fsync(disk) == 0;
    init::close_it(disk);
    return done ? init::Done{} : init::failed("empty " + device);
}

/// The label of the slot's file system, by which the loader finds it.
std::string label_of(std::size_t slot) { return slot == 0 ? "SLOTA" : "SLOTB"; }
std::string kernel_of(std::size_t slot) { return "C:" + label_of(slot) + ":" + kernel_file; }

} // namespace

init::Done Slots::look() {
    init::Done all_well{};
    for (std::size_t i = 0; i < slots_.size(); ++i) {
        slots_[i] = Slot{};
        slots_[i].state.state = init::SlotState::failed;
        const auto device = find_partition(slot_partitions[i]);
        if (device) slots_[i].device = *device;
        if (const auto done = device ? read(slots_[i]) : std::unexpected(device.error()); !done)
            all_well = done;
    }
    // The loader takes the newest, and marks it when it is not good.
    const auto rank = [](const Slot& slot) {
        return slot.state.state == init::SlotState::failed ? 0 : slot.state.revision;
    };
    running_ = rank(slots_[0]) >= rank(slots_[1]) ? 0 : 1;
    return all_well;
}

init::Done Slots::end_trial() {
    // The record first: an interruption after this counts as an interrupted start.
    if (auto kept = write(slots_[running_], Record{Standing::proven}); !kept) return kept;
    return write(slots_[running_], init::SlotState::good);
}

init::Done Slots::keep_trial() {
    if (running().state.state != init::SlotState::testing) return {};
    return write(slots_[running_], init::SlotState::installed);
}

init::Done Slots::end_start(bool other_is_whole) {
    Slot& slot = slots_[running_];
    Slot& other = slots_[1 - running_];
    if (slot.state.state == init::SlotState::failed) return {}; // it was not booted from a slot
    if (auto kept = write(slot, Record{Standing::proven}); !kept) return kept;
    const auto wanted =
        other_is_whole && other.is_good() ? init::SlotState::installed : init::SlotState::good;
    if (slot.state.state != wanted)
        if (auto kept = write(slot, wanted); !kept) return kept;
    if (!other_is_whole || !is_fallback(slot, other)) return {};
    init::BootState next = slot.state; // lower than the running one, but at least 1
    next.kernel = kernel_of(1 - running_);
    next.revision = std::max(slot.state.revision, 2U) - 1;
    return write(other, next);
}

init::Done Slots::judge_other() {
    Slot& other = slots_[1 - running_];
    const Record record = after_cut_short(other.record, is_harmed(other));
    if (auto kept = write(other, record); !kept) return kept;
    return record.standing == Standing::proven ? boot_other_next() : init::Done{};
}

init::Done Slots::need_other() const {
    if (on_trial())
        return std::unexpected("revision " + std::to_string(running().state.revision) +
                               " is on trial; that must end first");
    if (running().state.state == init::SlotState::failed || other().device.empty())
        return std::unexpected("the disk has no two slots; flash the box anew");
    return {};
}

init::Done Slots::rely_on_running() {
    return running().is_good() ? init::Done{} : write(slots_[running_], init::SlotState::good);
}

init::Done Slots::boot_other_next() {
    init::BootState next;
    next.kernel = kernel_of(1 - running_);
    next.revision = std::max(slots_[0].state.revision, slots_[1].state.revision) + 1;
    next.watchdog_s = running().state.watchdog_s;
    next.state = init::SlotState::installed;
    return write(slots_[1 - running_], next);
}

init::Done Slots::install(std::string_view kernel, std::string_view header) {
    if (auto there = need_other(); !there) return there;
    if (auto relied = rely_on_running(); !relied) return relied;
    Slot& other = slots_[1 - running_];
    const std::string label = label_of(1 - running_), record = encode(Record{});
    std::string utf_16;
    for (const char character : label) utf_16 += {character, '\0'};
    const std::array<std::pair<std::string_view, std::string_view>, 4> files{
        {{"EFILABEL", utf_16}, {kernel_file, kernel}, {header_file, header}, {record_file, record}}};
    if (auto emptied = empty_slot(other.device); !emptied) return emptied;
    {
        const MountedSlot slot{other.device, 0};
        if (!slot.is_there()) return init::failed("mount " + other.device);
        for (const auto& [name, bytes] : files)
            if (auto written = write_through(MountedSlot::file(name), O_CREAT, bytes); !written)
                return written;
    }
    { // mounted again, so that it is read from the disk
        const MountedSlot slot{other.device, MS_RDONLY};
        for (const auto& [name, bytes] : files)
            if (!slot.is_there() || init::read_text(MountedSlot::file(name)) != bytes)
                return std::unexpected(other.device +
                                       " does not keep what is written to it; change the disk");
    }
    other.header = header;
    other.record = {};
    return boot_other_next();
}

init::Done Slots::roll_back() {
    if (auto there = need_other(); !there) return there;
    if (!other().is_good())
        return std::unexpected("the other slot holds a version that failed, or none; install an update");
    if (auto relied = rely_on_running(); !relied) return relied;
    if (auto kept = write(slots_[1 - running_], Record{}); !kept) return kept;
    return boot_other_next();
}

init::Done Slots::give_up_running() {
    Slot& slot = slots_[running_];
    if (auto kept = write(slot, Record{Standing::harmed}); !kept) return kept;
    init::BootState state = slot.state;
    state.state = init::SlotState::failed;
    state.revision = 0; // as the loader leaves a failed one: it checks only the revision
    if (auto written = write(slot, state); !written) return written;
    running_ = 1 - running_;
    return {};
}

bool is_harmed(const Slot& slot) {
    const MountedSlot mounted{slot.device, MS_RDONLY};
    return !mounted.is_there() || !is_of(slot.header, init::read_text(MountedSlot::file(kernel_file)));
}

} // namespace tappet::box
