// SPDX-License-Identifier: Apache-2.0
// Partitions by name, and the loader's file in a slot.
#include "board/box/disk.hpp"

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
    [[nodiscard]] static std::string file() {
        return std::string{slot_folder} + "/" + std::string{init::boot_state_file};
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

init::Done Trial::look() {
    for (const char* name : slot_partitions) {
        const auto device = find_partition(name);
        if (!device) return std::unexpected(device.error());
        const MountedSlot slot{*device, MS_RDONLY};
        if (!slot.is_there()) return init::failed("mount " + *device);
        const auto state = init::decode(init::read_text(MountedSlot::file()));
        if (!state)
            return std::unexpected(std::string{init::boot_state_file} + " of " + name + " " + state.error());
        if (state->state == init::SlotState::testing) {
            device_ = *device;
            state_ = *state;
        }
    }
    return {};
}

init::Done Trial::end(init::SlotState how) {
    if (!is_on()) return {};
    init::BootState after = state_;
    after.state = how;
    const std::string bytes = init::encode(after);
    const MountedSlot slot{device_, 0};
    const int file = slot.is_there() ? ::open(MountedSlot::file().c_str(), O_WRONLY | O_CLOEXEC) : -1;
    const bool written = file >= 0 &&
                         ::write(file, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()) &&
                         ::fsync(file) == 0;
    const int error = errno;
    if (file >= 0) ::close(file);
    errno = error;
    if (!written) return init::failed("write " + std::string{init::boot_state_file} + " of " + device_);
    device_.clear();
    return {};
}

} // namespace tappet::box
