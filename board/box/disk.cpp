// SPDX-License-Identifier: Apache-2.0
// Partitions by name, and the loader's file in a slot.
#include "board/box/disk.hpp"

#include <algorithm>
#include <cerrno>

#include <fcntl.h>
#include <sys/mount.h>
#include <unistd.h>

namespace tappet::box {

namespace {

constexpr const char* slot_folder = "/run/slot";

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

} // namespace

std::expected<std::string, std::string> find_partition(const std::string& name) {
    std::string found;
    for (const std::string& block : init::names_in("/sys/class/block")) {
        if (!init::read_text("/sys/class/block/" + block + "/uevent").contains("\nPARTNAME=" + name + "\n"))
            continue;
        if (!found.empty())
            return std::unexpected("partition \"" + name + "\" is on two disks, as " + found + " and /dev/" +
                                   block + "; remove one of them");
        found = "/dev/" + block;
    }
    if (found.empty())
        return std::unexpected("no disk has a partition \"" + name +
                               "\"; check the disk, and that the board's modules name its controller");
    return found;
}

init::Done mount_data(const std::string& device, const std::string& folder) {
    init::make_folder(folder);
    if (::mount(device.c_str(), folder.c_str(), "ext4", MS_NOSUID | MS_NODEV | MS_NOEXEC | MS_NOATIME,
                "commit=1,errors=remount-ro") != 0)
        return init::failed("mount " + device + " at " + folder);
    return {};
}

namespace {

std::string state_file() { return MountedSlot::file(init::boot_state_file); }

std::expected<init::BootState, std::string> read_state(const std::string& device) {
    const MountedSlot slot{device, MS_RDONLY};
    if (!slot.is_there()) return init::failed("mount " + device);
    auto state = init::decode(init::read_text(state_file()));
    if (!state)
        return std::unexpected(std::string{init::boot_state_file} + " of " + device + " " + state.error());
    return state;
}

/// To the disk itself before it returns.
init::Done write_through(const std::string& path, int how, std::string_view bytes) {
    const int file = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | how, 0600);
    bool written = file >= 0;
    while (written && !bytes.empty()) {
        const ssize_t count = ::write(file, bytes.data(), bytes.size());
        written = count > 0;
        bytes.remove_prefix(written ? static_cast<std::size_t>(count) : 0);
    }
    written = written && ::fsync(file) == 0;
    const int error = errno;
    if (file >= 0) ::close(file);
    errno = error;
    return written ? init::Done{} : init::failed("write " + path);
}

init::Done write_state(const std::string& device, const init::BootState& state) {
    const MountedSlot slot{device, 0};
    if (!slot.is_there()) return init::failed("mount " + device);
    return write_through(state_file(), O_CREAT,
                         init::encode(state)); // not shortened first: it is of one length
}

} // namespace

init::Done Slots::look() {
    init::Done all_well{};
    for (std::size_t i = 0; i < slots_.size(); ++i) {
        slots_[i].state.state = init::SlotState::failed;
        const auto device = find_partition(slot_partitions[i]);
        const auto state = device ? read_state(*device) : std::unexpected(device.error());
        if (device) slots_[i].device = *device;
        if (!state) {
            all_well = std::unexpected(state.error());
            continue;
        }
        slots_[i].state = *state;
        if (state->state != init::SlotState::testing) continue;
        trial_ = i;
        revision_ = state->revision;
    }
    return all_well;
}

init::Done Slots::end_trial(init::SlotState how) {
    if (!on_trial()) return {};
    Slot& slot = slots_[trial_];
    slot.state.state = how;
    const auto written = write_state(slot.device, slot.state);
    if (written) trial_ = none;
    return written;
}

init::Done Slots::install(std::string_view kernel) {
    if (on_trial())
        return std::unexpected("revision " + std::to_string(revision_) + " is on trial; that must end first");
    const auto rank = [&](std::size_t i) {
        return slots_[i].state.state == init::SlotState::failed ? 0 : slots_[i].state.revision;
    };
    const std::size_t running = rank(0) >= rank(1) ? 0 : 1;
    const Slot& other = slots_[1 - running];
    if (rank(running) == 0 || other.device.empty())
        return std::unexpected("the disk has no two slots; flash the box anew");
    const std::string file = "tappet.efi";
    {
        const MountedSlot slot{other.device, 0};
        if (!slot.is_there()) return init::failed("mount " + other.device);
        if (auto written = write_through(MountedSlot::file(file), O_CREAT | O_TRUNC, kernel); !written)
            return written;
    }
    { // mounted anew, it is read from the disk
        const MountedSlot slot{other.device, MS_RDONLY};
        if (!slot.is_there() || init::read_text(MountedSlot::file(file)) != kernel)
            return std::unexpected(other.device + " does not keep what is written to it; change the disk");
    }
    init::BootState next = slots_[running].state;
    next.kernel = std::string{"C:SLOT"} + (running == 0 ? "B" : "A") + ":" + file;
    next.revision = std::max(slots_[0].state.revision, slots_[1].state.revision) + 1;
    next.state = init::SlotState::installed;
    return write_state(other.device, next);
}

} // namespace tappet::box
