// SPDX-License-Identifier: Apache-2.0
// Partitions by name, and the loader's file in a slot.
#include "board/box/disk.hpp"

#include "board/box/update.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <linux/fs.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mount.h>
#include <sys/wait.h>
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

namespace {

/// As the image's writer makes the data partition.
constexpr std::size_t block_bytes = 1024;
constexpr std::size_t number_bytes = sizeof(std::uint64_t);

/// Where the second copy of its head is.
const std::vector<std::string> second_head{"-b", "8193", "-B", "1024"};

struct Checked {
    int code = 8;
    std::string said{};
};

/// Mends what needs no guess. Nobody else has children yet.
Checked check(const std::string& device, const std::vector<std::string>& more,
              const std::function<void()>& meanwhile) {
    std::vector<std::string> words{"/bin/e2fsck", "-p"};
    words.insert(words.end(), more.begin(), more.end());
    words.push_back(device);
    int ends[2] = {-1, -1};
    if (::pipe2(ends, O_CLOEXEC) != 0) return {8, init::failed("pipe").error()};
    const auto checker = init::start(words, ends[1], "write the image anew");
    ::close(ends[1]);
    Checked checked;
    char piece[1024];
    for (ssize_t count = 1; count > 0;) {
        pollfd file{ends[0], POLLIN, 0};
        meanwhile();
        if (::poll(&file, 1, 10) == 0) continue;
        count = ::read(ends[0], piece, sizeof piece);
        checked.said.append(piece, static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    }
    ::close(ends[0]);
    int status = 0;
    if (checker && ::waitpid(*checker, &status, 0) == *checker) checked.code = init::to_exit_code(status);
    std::ranges::replace(checked.said, '\n', ' ');
    return checked;
}

} // namespace

std::string numbered_blocks(std::string_view file_system) {
    std::string blocks;
    for (std::uint64_t number = 0; number * block_bytes < file_system.size(); ++number) {
        const std::string_view block = file_system.substr(number * block_bytes, block_bytes);
        if (block.find_first_not_of('\0') == std::string_view::npos) continue;
        blocks.append(reinterpret_cast<const char*>(&number), number_bytes);
        blocks.append(block);
    }
    return blocks;
}

namespace {

/// Its head last: a power cut in between leaves none that could be taken for whole.
init::Done make_anew(const std::string& device, const std::function<void()>& meanwhile) {
    const std::string blocks = init::read_text(empty_data_file);
    if (blocks.empty()) return std::unexpected("the image has no empty one; write the image anew");
    const int disk = ::open(device.c_str(), O_RDWR | O_EXCL | O_CLOEXEC);
    std::uint64_t bytes = 0;
    bool done = disk >= 0 && ::ioctl(disk, BLKGETSIZE64, &bytes) == 0;
    for (std::array<std::uint64_t, 2> part{0, 0}; done && part[0] < bytes; part[0] += part[1]) {
        part[1] = std::min<std::uint64_t>(4 * 1024 * 1024, bytes - part[0]); // from, and how many
        done = ::ioctl(disk, BLKZEROOUT, part.data()) == 0;
        meanwhile();
    }
    for (std::size_t end = blocks.size(); done && end != 0;) {
        end -= number_bytes + block_bytes;
        std::uint64_t number = 0;
        std::memcpy(&number, blocks.data() + end, number_bytes);
        done = (end != 0 || ::fsync(disk) == 0) &&
               ::pwrite(disk, blocks.data() + end + number_bytes, block_bytes,
                        static_cast<off_t>(number * block_bytes)) == block_bytes;
    }
    done = done && ::fsync(disk) == 0;
    const int error = errno;
    if (disk >= 0) ::close(disk);
    errno = error;
    return done ? init::Done{} : init::failed("write " + device);
}

bool mount_it(const std::string& device, const std::string& folder) {
    init::make_folder(folder);
    return ::mount(device.c_str(), folder.c_str(), "ext4", MS_NOSUID | MS_NODEV | MS_NOEXEC | MS_NOATIME,
                   "commit=1,errors=remount-ro") == 0;
}

} // namespace

std::expected<std::string, std::string> mount_data(const std::string& device, const std::string& folder,
                                                   const std::function<void()>& meanwhile) {
    constexpr int mended = 1;     // above: what only a guess would mend
    constexpr int not_begun = 16; // from here on it has judged nothing
    Checked checked = check(device, {}, meanwhile);
    bool is_mounted = checked.code <= mended && mount_it(device, folder);
    // A power cut may tear the head, of which the sum is then wrong; and of one that calls itself clean it
    // looks at nothing else.
    for (const auto& more : {second_head, std::vector<std::string>{"-f"}}) {
        if (is_mounted || checked.code >= not_begun) break;
        checked = check(device, more, meanwhile);
        is_mounted = checked.code <= mended && mount_it(device, folder);
    }
    if (is_mounted)
        return checked.code == mended ? "the data partition is mended: " + checked.said : std::string{};
    if (checked.code <= mended) return init::failed("mount " + device + " at " + folder);
    if (checked.code >= not_begun) return std::unexpected("e2fsck does not run: " + checked.said);
    if (const auto made = make_anew(device, meanwhile); !made)
        return std::unexpected(device + " is damaged, and takes no new file system: " + made.error());
    if (!mount_it(device, folder)) return init::failed("mount " + device + " at " + folder);
    return "the data partition was beyond mending, and is made anew: SETTINGS AND LEARNED VALUES ARE GONE; "
           "e2fsck said \"" +
           checked.said + "\"";
}

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

namespace {

std::string state_file() { return MountedSlot::file(init::boot_state_file); }

std::expected<init::BootState, std::string> read_state(const std::string& device, std::string& header) {
    const MountedSlot slot{device, MS_RDONLY};
    if (!slot.is_there()) return init::failed("mount " + device);
    header = init::read_text(MountedSlot::file(header_file));
    auto state = init::decode(init::read_text(state_file()));
    if (!state)
        return std::unexpected(std::string{init::boot_state_file} + " of " + device + " " + state.error());
    return state;
}

/// A file system without a file, whatever a power cut left of the one before: clusters of no file would fill
/// the slot, and a torn table would refuse every version. Its first sector, which says how it is laid out, is
/// nowhere written.
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
    const int error = errno;
    if (disk >= 0) ::close(disk);
    errno = error;
    return done ? init::Done{} : init::failed("empty " + device);
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
        const auto state = device ? read_state(*device, slots_[i].header) : std::unexpected(device.error());
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

std::array<const Slots::Slot*, 2> Slots::in_order() const {
    const auto rank = [&](const Slot& slot) {
        return slot.state.state == init::SlotState::failed ? 0 : slot.state.revision;
    };
    const std::size_t running = on_trial() ? trial_ : rank(slots_[0]) >= rank(slots_[1]) ? 0 : 1;
    return {&slots_[running], &slots_[1 - running]};
}

std::expected<std::size_t, std::string> Slots::free_slot() const {
    if (on_trial())
        return std::unexpected("revision " + std::to_string(revision_) + " is on trial; that must end first");
    const auto [running, other] = in_order();
    if (running->state.state == init::SlotState::failed || other->device.empty())
        return std::unexpected("the disk has no two slots; flash the box anew");
    return static_cast<std::size_t>(other - slots_.data());
}

namespace {
/// Of the slot's file system, as the loader looks for it.
std::string label_of(std::size_t slot) { return slot == 0 ? "SLOTA" : "SLOTB"; }
} // namespace

init::Done Slots::put_on_trial(std::size_t slot, std::uint16_t watchdog_s) {
    init::BootState next;
    next.kernel = "C:" + label_of(slot) + ":" + kernel_file;
    next.revision = std::max(slots_[0].state.revision, slots_[1].state.revision) + 1;
    next.watchdog_s = watchdog_s;
    next.state = init::SlotState::installed;
    return write_state(slots_[slot].device, next);
}

init::Done Slots::install(std::string_view kernel, std::string_view header) {
    const auto free = free_slot();
    if (!free) return std::unexpected(free.error());
    const std::string& device = slots_[*free].device;
    std::string label; // UTF-16
    for (const char character : label_of(*free)) label += {character, '\0'};
    const std::array<std::pair<std::string_view, std::string_view>, 3> files{
        {{"EFILABEL", label}, {kernel_file, kernel}, {header_file, header}}};
    if (auto emptied = empty_slot(device); !emptied) return emptied;
    {
        const MountedSlot slot{device, 0};
        if (!slot.is_there()) return init::failed("mount " + device);
        for (const auto& [name, bytes] : files)
            if (auto written = write_through(MountedSlot::file(name), O_CREAT, bytes); !written)
                return written;
    }
    { // mounted anew, it is read from the disk
        const MountedSlot slot{device, MS_RDONLY};
        for (const auto& [name, bytes] : files)
            if (!slot.is_there() || init::read_text(MountedSlot::file(name)) != bytes)
                return std::unexpected(device + " does not keep what is written to it; change the disk");
    }
    return put_on_trial(*free, in_order()[0]->state.watchdog_s);
}

init::Done Slots::give_up_running() {
    Slot& slot = slots_[static_cast<std::size_t>(in_order()[0] - slots_.data())];
    slot.state.state = init::SlotState::failed;
    slot.state.revision = 0; // as the loader leaves one that failed: it looks at the revision alone
    return write_state(slot.device, slot.state);
}

bool is_harmed(const Slots::Slot& slot) {
    const MountedSlot mounted{slot.device, MS_RDONLY};
    return mounted.is_there() && !is_of(slot.header, init::read_text(MountedSlot::file(kernel_file)));
}

init::Done Slots::roll_back() {
    const auto free = free_slot();
    if (!free) return std::unexpected(free.error());
    if (slots_[*free].state.state == init::SlotState::failed)
        return std::unexpected("the other slot holds a version that failed, or none; bring an update");
    return put_on_trial(*free, slots_[*free].state.watchdog_s);
}

} // namespace tappet::box
