// Writes whole texts with write(2), continues after interruptions, and does not wait where that is required.
#include "kernel/os/terminal.hpp"

#include "kernel/base/text.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <climits>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <optional>

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

namespace tappet::os {

namespace {

// One of the two files whose other end belongs to other people.
class Outlet {
public:
    explicit constexpr Outlet(int file) noexcept : file_{file} {}

    // A pipe or a terminal is opened anew so that it can be made non-blocking: O_NONBLOCK on the given file
    // would hold for everybody who shares it, including the shell, and would outlive a killed process. A
    // socket cannot be opened anew; each call asks it not to wait. A file that this process may not open (the
    // terminal of another user, a device that opens only once) is polled before each piece that fits into the
    // known room: only another writer could take that room in between. A regular file does not wait for a
    // reader, and opened anew it would be written at another place.
    void never_wait() noexcept {
        const std::lock_guard lock{mutex_};
        if (own_ >= 0) ::close(own_);
        own_ = -1;
        rest_length_ = 0;
        untold_ = 0;
        struct stat facts{};
        if (fstat(file_, &facts) != 0) {
            how_ = How::not_at_all;
        } else if (S_ISREG(facts.st_mode)) {
            how_ = How::as_given;
        } else if (S_ISSOCK(facts.st_mode)) {
            how_ = How::as_socket;
        } else {
            const Sentence path{"/proc/self/fd/", file_};
            own_ = open(path.characters, O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
            // ENXIO: a pipe whose reader is already gone.
            how_ = own_ >= 0 ? How::opened_anew : errno == ENXIO ? How::not_at_all : How::asked_first;
            piece_ = isatty(file_) != 0 ? 1 : PIPE_BUF;
        }
    }
    [[nodiscard]] bool waits() const noexcept { return how_ == How::waiting; }

    bool write_or_drop(std::string_view text) noexcept {
        const std::lock_guard lock{mutex_};
        if (write_rest() && tell_dropped() && write_new(text)) return true;
        ++untold_;
        dropped.fetch_add(1, std::memory_order_relaxed);
        return false;
    }

    static constinit std::atomic<std::uint64_t> dropped;

private:
    enum class How : std::uint8_t { waiting, as_given, opened_anew, asked_first, as_socket, not_at_all };

    [[nodiscard]] std::size_t write_some(std::string_view text) const noexcept {
        ssize_t written = -1;
        do switch (how_) {
            case How::as_given: written = write(file_, text.data(), text.size()); break;
            case How::opened_anew: written = write(own_, text.data(), text.size()); break;
            case How::asked_first: {
                std::size_t all = 0;
                for (pollfd room{file_, POLLOUT, 0};
                     all < text.size() && poll(&room, 1, 0) == 1 && room.revents == POLLOUT;) {
                    written = write(file_, text.data() + all, std::min(piece_, text.size() - all));
                    if (written <= 0) break;
                    all += static_cast<std::size_t>(written);
                }
                return all;
            }
            case How::as_socket:
                written = send(file_, text.data(), text.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
                break;
            case How::waiting:
            case How::not_at_all: return 0;
            }
        while (written < 0 && errno == EINTR);
        return written < 0 ? 0 : static_cast<std::size_t>(written);
    }
    bool write_rest() noexcept {
        if (rest_length_ == 0) return true;
        const std::size_t written = write_some({rest_, rest_length_});
        rest_length_ -= written;
        std::memmove(rest_, rest_ + written, rest_length_);
        return rest_length_ == 0;
    }
    // A partly written text is finished later: nobody reads half a line.
    bool write_new(std::string_view text) noexcept {
        const std::size_t written = write_some(text);
        if (written == text.size()) return true;
        if (written == 0) return false;
        text.remove_prefix(written);
        rest_length_ = text.size() < sizeof rest_ ? text.size() : sizeof rest_;
        std::memcpy(rest_, text.data(), rest_length_);
        return rest_length_ == text.size();
    }
    bool tell_dropped() noexcept {
        if (untold_ == 0) return true;
        const Sentence line{"(", untold_, untold_ == 1 ? " text was" : " texts were",
                            " dropped here: they were not read in time)\n"};
        if (!write_new(line.view())) return false;
        untold_ = 0;
        return rest_length_ == 0;
    }

    std::mutex mutex_{};
    int file_;
    int own_ = -1;
    How how_ = How::waiting;
    std::size_t piece_ = 1;
    std::uint64_t untold_ = 0;
    std::size_t rest_length_ = 0;
    char rest_[4096] = {};
};

constinit std::atomic<std::uint64_t> Outlet::dropped{0};
// If the standard files are closed at start, a bus or a valve would be opened in their place and printed to.
[[gnu::constructor]] void occupy_standard_files() noexcept {
    for (int file = STDIN_FILENO; file <= STDERR_FILENO; ++file)
        if (fcntl(file, F_GETFD) < 0) static_cast<void>(open("/dev/null", O_RDWR));
}

constinit Outlet outlets[] = {Outlet{STDOUT_FILENO}, Outlet{STDERR_FILENO}};

} // namespace

void never_wait() noexcept {
    for (Outlet& each : outlets) each.never_wait();
}

std::uint64_t dropped_texts() noexcept { return Outlet::dropped.load(std::memory_order_relaxed); }

bool write_all(int file, std::string_view text) noexcept {
    if (file == STDOUT_FILENO || file == STDERR_FILENO)
        if (Outlet& outlet = outlets[file - STDOUT_FILENO]; !outlet.waits())
            return outlet.write_or_drop(text);
    while (!text.empty()) {
        const ssize_t written = write(file, text.data(), text.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return false;
        text.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
}

namespace {
constinit std::atomic<bool> print_failed{false};
} // namespace

void print(std::string_view text) noexcept {
    if (!write_all(STDOUT_FILENO, text)) print_failed.store(true, std::memory_order_relaxed);
}

bool has_printed_all() noexcept { return !print_failed.load(std::memory_order_relaxed); }

namespace {

/// Syncs the directory of a file: a new name is on the disk only when its directory is.
bool sync_directory(const char* path) noexcept {
    char directory[4096] = ".";
    if (const char* slash = std::strrchr(path, '/'); slash != nullptr) {
        const std::size_t length = slash == path ? 1 : static_cast<std::size_t>(slash - path);
        std::memcpy(directory, path, length);
        directory[length] = '\0';
    }
    const int file = open(directory, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (file < 0) return false;
    const bool synced = fsync(file) == 0 || errno == EINVAL; // some file systems cannot sync directories
    close(file);
    return synced;
}

} // namespace

namespace {

using Path = std::array<char, 4096>;

/// Writes the name that `path` leads to, through symbolic links, into `target`. Returns what stands there;
/// empty: nothing does, and `target` is `path`.
std::optional<struct stat> find_target(const char* path, Path& target) noexcept {
    const std::size_t length = std::strlen(path);
    if (length < target.size()) std::memcpy(target.data(), path, length + 1);
    const int there = open(path, O_PATH | O_CLOEXEC);
    if (there < 0) return {};
    struct stat facts{};
    char by_number[40] = "/proc/self/fd/";
    *std::to_chars(by_number + 14, by_number + sizeof by_number - 1, there).ptr = '\0';
    const bool known = fstat(there, &facts) == 0;
    const ssize_t count = readlink(by_number, target.data(), target.size() - 1);
    close(there);
    if (!known || count <= 0) return {};
    target[static_cast<std::size_t>(count)] = '\0';
    return facts;
}

bool write_into(int file, std::span<const std::string_view> pieces) noexcept {
    for (const std::string_view piece : pieces)
        if (!write_all(file, piece)) return false;
    return fsync(file) == 0 || errno == EINVAL; // a device or a pipe cannot be synced
}

/// A device or a pipe is no file that another could replace.
bool write_to_device(const char* path, std::span<const std::string_view> pieces) noexcept {
    const int file = open(path, O_WRONLY | O_CLOEXEC | O_NONBLOCK); // a pipe that nobody reads is refused
    if (file < 0) return false;
    fcntl(file, F_SETFL, 0);
    const bool written = write_into(file, pieces);
    return close(file) == 0 && written;
}

} // namespace

bool replace_file(const char* path, std::span<const std::string_view> pieces) noexcept {
    Path target{};
    const auto there = find_target(path, target);
    struct stat link{};
    if (!there && lstat(path, &link) == 0) return false; // a link to nothing
    if (there && !S_ISREG(there->st_mode)) return !S_ISDIR(there->st_mode) && write_to_device(path, pieces);
    constexpr std::string_view ending = ".tappet-new";
    Path beside = target;
    const std::size_t length = std::strlen(target.data());
    if (length == 0 || length + ending.size() + 1 > beside.size()) return false;
    std::memcpy(beside.data() + length, ending.data(), ending.size());
    unlink(beside.data()); // left over from a power failure; were it a link, its target would stay
    const int file = open(beside.data(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    if (file < 0) return false;
    bool written = write_into(file, pieces);
    if (there) {
        written = written && fchmod(file, there->st_mode & 07777) == 0;
        static_cast<void>(fchown(file, there->st_uid, there->st_gid)); // only root may give a file away
    }
    if (close(file) == 0 && written && rename(beside.data(), target.data()) == 0)
        return sync_directory(target.data());
    unlink(beside.data());
    return false;
}

} // namespace tappet::os
