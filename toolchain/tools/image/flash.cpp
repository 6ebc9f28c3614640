// SPDX-License-Identifier: Apache-2.0
#include "toolchain/tools/image/flash.hpp"

#include "toolchain/tools/image/tool.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include <fcntl.h>
#include <linux/fs.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

namespace tappet::image {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t piece_bytes = 1024 * 1024;
/// The end of a disk may hold the second copy of an old partition table.
constexpr std::size_t old_table_bytes = 64 * 512;

class File {
public:
    File(const fs::path& path, int how) : path_{path}, descriptor_{::open(path.c_str(), how | O_CLOEXEC)} {
        if (descriptor_ < 0)
            throw Fault("cannot open " + path.string() + ": " + std::strerror(errno) + "; run it as root");
    }
    ~File() { ::close(descriptor_); }
    File(const File&) = delete;
    File& operator=(const File&) = delete;

    [[nodiscard]] int descriptor() const { return descriptor_; }
    [[nodiscard]] std::uint64_t bytes() const {
        std::uint64_t size = 0;
        struct stat facts{};
        if (::fstat(descriptor_, &facts) == 0 && S_ISREG(facts.st_mode))
            return static_cast<std::uint64_t>(facts.st_size);
        return ::ioctl(descriptor_, BLKGETSIZE64, &size) == 0 ? size : 0;
    }
    [[nodiscard]] std::string read(std::uint64_t at, std::size_t count) const {
        std::string bytes(count, '\0');
        for (std::size_t have = 0; have < count;) {
            const ssize_t n =
                ::pread(descriptor_, bytes.data() + have, count - have, static_cast<off_t>(at + have));
            if (n <= 0)
                throw Fault("cannot read " + path_.string() + " at byte " + std::to_string(at + have) + ": " +
                            std::strerror(errno));
            have += static_cast<std::size_t>(n);
        }
        return bytes;
    }
    void write(std::uint64_t at, std::string_view bytes) const {
        while (!bytes.empty()) {
            const ssize_t n = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(at));
            if (n <= 0)
                throw Fault("cannot write " + path_.string() + " at byte " + std::to_string(at) + ": " +
                            std::strerror(errno));
            at += static_cast<std::uint64_t>(n);
            bytes.remove_prefix(static_cast<std::size_t>(n));
        }
    }

private:
    fs::path path_;
    int descriptor_;
};

/// Returns the disk's own name and the base of its partitions', as in the kernel: "sdb", "sdb1".
std::string disk_of(const fs::path& device) {
    struct stat facts{};
    if (::stat(device.c_str(), &facts) != 0 || !S_ISBLK(facts.st_mode)) return {};
    const fs::path node =
        "/sys/dev/block/" + std::to_string(major(facts.st_rdev)) + ":" + std::to_string(minor(facts.st_rdev));
    std::error_code error;
    const fs::path real = fs::canonical(node, error);
    if (error) return {};
    return (fs::exists(real / "partition") ? real.parent_path() : real).filename().string();
}

/// Returns the line of /proc/mounts or /proc/swaps that uses a disk or a part of it.
std::string user_of(const std::string& disk) {
    for (const char* table : {"/proc/mounts", "/proc/swaps"}) {
        std::ifstream lines{table};
        for (std::string line; std::getline(lines, line);) {
            std::istringstream words{line};
            std::string device, where;
            words >> device >> where;
            if (device.starts_with("/dev/") && disk_of(device) == disk)
                return device + (std::string_view{table} == "/proc/mounts" ? " is mounted at " + where
                                                                           : " is swapped to");
        }
    }
    return {};
}

bool is_empty(const File& disk) {
    const std::string head = disk.read(0, std::min<std::uint64_t>(disk.bytes(), piece_bytes));
    return head.find_first_not_of('\0') == std::string::npos;
}

} // namespace

std::string refusal_to_flash(const fs::path& image, const fs::path& device, bool erase) {
    struct stat facts{};
    if (::stat(device.c_str(), &facts) != 0) return device.string() + " is not there; lsblk lists the disks";
    if (!S_ISBLK(facts.st_mode) && !S_ISREG(facts.st_mode))
        return device.string() + " is neither a disk nor a file; lsblk lists the disks";
    if (S_ISBLK(facts.st_mode)) {
        const std::string disk = disk_of(device);
        if (disk.empty() || disk != device.filename())
            return device.string() + " is a part of " + (disk.empty() ? "an unknown disk" : "/dev/" + disk) +
                   "; name the whole disk";
        if (const std::string user = user_of(disk); !user.empty())
            return user + "; unmount it, or name another disk";
    }
    const File disk{device, O_RDONLY};
    if (const std::uint64_t needed = fs::file_size(image); disk.bytes() < needed)
        return device.string() + " has " + std::to_string(disk.bytes() / 1'000'000) +
               " MB, and the image needs " + std::to_string(needed / 1'000'000) + "; take a larger disk";
    if (!erase && !is_empty(disk))
        return device.string() + " is not empty: its contents would be lost, a machine's settings too; add "
                                 "--erase to overwrite it";
    return {};
}

void flash(const fs::path& image, const fs::path& device,
           const std::function<void(std::uint64_t, std::uint64_t)>& done) {
    const File from{image, O_RDONLY};
    const std::uint64_t all = from.bytes();
    const auto pieces = [&](const auto& act, std::uint64_t before) {
        for (std::uint64_t at = 0; at < all; at += piece_bytes) {
            act(at, from.read(at, std::min<std::uint64_t>(piece_bytes, all - at)));
            if (done) done(before + at, 2 * all);
        }
    };
    {
        const File to{device, O_WRONLY | O_EXCL}; // the kernel also refuses this for a disk in use
        if (to.bytes() > all + old_table_bytes)
            to.write(to.bytes() - old_table_bytes, std::string(old_table_bytes, '\0'));
        pieces([&](std::uint64_t at, const std::string& bytes) { to.write(at, bytes); }, 0);
        if (::fsync(to.descriptor()) != 0)
            throw Fault("cannot write " + device.string() + ": " + std::strerror(errno));
        ::ioctl(to.descriptor(), BLKFLSBUF, 0); // fails for a file, which has no such cache
        ::posix_fadvise(to.descriptor(), 0, 0, POSIX_FADV_DONTNEED);
    }
    const File back{device, O_RDONLY};
    pieces(
        [&](std::uint64_t at, const std::string& bytes) {
            if (back.read(at, bytes.size()) != bytes)
                throw Fault(device.string() + " does not hold what was written at byte " +
                            std::to_string(at) + "; take another disk");
        },
        all);
}

} // namespace tappet::image
