// SPDX-License-Identifier: Apache-2.0
// Finds partitions by name; mounts the data partition.
#include "board/box/disk.hpp"
#include "kernel/base/crc.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include <fcntl.h>
#include <linux/fs.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tappet::box {

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

/// The block size that the image's writer uses for the data partition.
constexpr std::size_t block_bytes = 1024;
constexpr std::size_t number_bytes = sizeof(std::uint64_t);

/// The location of the second superblock.
const std::vector<std::string> second_head{"-b", "8193", "-B", "1024"};

struct Checked {
    int code = 8;
    std::string said{};
};

/// Repairs what needs no guess. init has no other children at this time.
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

/// Writes the superblock last, so that a power cut in between leaves none that looks valid.
init::Done make_anew(const std::string& device, const std::function<void()>& meanwhile) {
    const std::string blocks = init::read_text(empty_data_file);
    if (blocks.empty()) return std::unexpected("the image has no empty one; write the image anew");
    const int disk = ::open(device.c_str(), O_RDWR | O_EXCL | O_CLOEXEC);
    std::uint64_t bytes = 0;
    bool done = disk >= 0 && ::ioctl(disk, BLKGETSIZE64, &bytes) == 0;
    for (std::array<std::uint64_t, 2> part{0, 0}; done && part[0] < bytes; part[0] += part[1]) {
        part[1] = std::min<std::uint64_t>(4 * 1024 * 1024, bytes - part[0]); // offset and length
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
    init::close_it(disk);
    return done ? init::Done{} : init::failed("write " + device);
}

/// An ext4 superblock is valid when its magic number and its checksum, if it has one, are correct.
enum class Head : std::uint8_t { none, whole, unreadable };

Head look_at_head(int disk, off_t at) {
    constexpr std::size_t magic = 0x38, features = 0x64, sum = 0x3FC;
    constexpr std::uint32_t has_sums = 0x400;
    std::array<std::uint8_t, 1024> head{};
    if (::pread(disk, head.data(), head.size(), at) != static_cast<ssize_t>(head.size()))
        return Head::unreadable;
    const auto word = [&](std::size_t place) {
        std::uint32_t value = 0;
        std::memcpy(&value, head.data() + place, sizeof value);
        return value;
    };
    if ((word(magic) & 0xFFFF) != 0xEF53) return Head::none;
    return (word(features) & has_sums) == 0 || word(sum) == ~crc32({head.data(), sum}, castagnoli)
               ? Head::whole
               : Head::none;
}

/// e2fsck has a single code for a missing file system, an unreadable disk and lack of memory. Only the first
/// permits making a new one: both superblocks are readable and neither is one.
bool has_no_file_system(const std::string& device) {
    constexpr off_t first = 1024, second = 8193 * 1024;
    const int disk = ::open(device.c_str(), O_RDONLY | O_CLOEXEC);
    if (disk < 0) return false;
    const bool none = look_at_head(disk, first) == Head::none && look_at_head(disk, second) == Head::none;
    ::close(disk);
    return none;
}

bool mount_it(const std::string& device, const std::string& folder) {
    init::make_folder(folder);
    return ::mount(device.c_str(), folder.c_str(), "ext4", MS_NOSUID | MS_NODEV | MS_NOEXEC | MS_NOATIME,
                   "commit=1,errors=remount-ro") == 0;
}

} // namespace

std::expected<std::string, std::string> mount_data(const std::string& device, const std::string& folder,
                                                   const std::function<void()>& meanwhile) {
    constexpr int mended = 1;     // above: a repair would need a guess
    constexpr int failed = 8;     // from here on the check failed
    constexpr int not_begun = 16; // from here on it did not start
    Checked checked = check(device, {}, meanwhile);
    bool is_mounted = checked.code <= mended && mount_it(device, folder);
    // A power cut may tear the superblock, whose checksum is then wrong; and when a superblock says that it
    // is clean, e2fsck checks nothing else.
    for (const auto& more : {second_head, std::vector<std::string>{"-f"}}) {
        if (is_mounted || checked.code >= not_begun) break;
        checked = check(device, more, meanwhile);
        is_mounted = checked.code <= mended && mount_it(device, folder);
    }
    if (is_mounted)
        return checked.code == mended ? "the data partition is repaired: " + checked.said : std::string{};
    if (checked.code <= mended) return init::failed("mount " + device + " at " + folder);
    if (checked.code >= not_begun) return std::unexpected("e2fsck does not run: " + checked.said);
    if (checked.code >= failed && !has_no_file_system(device))
        return std::unexpected(
            device + " has a file system that could not be checked; look at the disk: e2fsck said \"" +
            checked.said + "\"");
    if (const auto made = make_anew(device, meanwhile); !made)
        return std::unexpected(device +
                               " is damaged, and a new file system cannot be written: " + made.error());
    if (!mount_it(device, folder)) return init::failed("mount " + device + " at " + folder);
    return "the data partition could not be repaired, and was created anew: SETTINGS AND LEARNED VALUES ARE "
           "GONE; "
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
    init::close_it(file);
    return written ? init::Done{} : init::failed("write " + path);
}

} // namespace tappet::box
