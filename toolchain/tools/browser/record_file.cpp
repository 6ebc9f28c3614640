// The writer locks the file: `report stop` finds its process by the lock, and a second writer is refused.
#include "toolchain/tools/browser/record_file.hpp"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>

#include <fcntl.h>
#include <unistd.h>

namespace tappet::browser {

namespace {

/// The lock by which a recorder is found: behind the end of any file, where nobody else locks.
struct flock recorders_lock() {
    struct flock lock{};
    lock.l_type = F_WRLCK;
    lock.l_whence = SEEK_SET;
    lock.l_start = off_t{0x7461707065};
    lock.l_len = 1;
    return lock;
}
bool is_recorders(const struct flock& held) {
    return held.l_start == recorders_lock().l_start && held.l_len == 1 && held.l_pid > 1;
}

/// Syncs the folder, so that the file's name survives a power cut like its content.
void sync_folder_of(const std::string& name) {
    const std::filesystem::path folder = std::filesystem::absolute(name).parent_path();
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return;
    static_cast<void>(::fsync(descriptor));
    ::close(descriptor);
}

} // namespace

Result<std::unique_ptr<RecordFile>> RecordFile::create(const std::string& name) {
    const int descriptor = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    if (descriptor < 0 && errno == EEXIST) return wrong("'" + name + "' is there already; name another file");
    if (descriptor < 0)
        return wrong("'" + name + "' cannot be made: " + std::strerror(errno) +
                     "; check that its folder exists and that you may write there");
    struct flock lock = recorders_lock();
    static_cast<void>(::fcntl(descriptor, F_SETLK, &lock)); // without it the writer cannot be found: no harm
    sync_folder_of(name);
    return std::unique_ptr<RecordFile>{new RecordFile{name, descriptor}};
}

RecordFile::RecordFile(std::string name, int descriptor) : name_{std::move(name)}, descriptor_{descriptor} {
    thread_ = std::thread{[this] { run(); }};
}

RecordFile::~RecordFile() {
    static_cast<void>(finish());
    ::close(descriptor_);
}

void RecordFile::write(std::string bytes) {
    const std::lock_guard lock{mutex_};
    waiting_ += bytes;
}

bool RecordFile::is_behind() const {
    const std::lock_guard lock{mutex_};
    return waiting_.size() > most_waiting;
}

std::string RecordFile::fault() const {
    const std::lock_guard lock{mutex_};
    return fault_;
}

Result<void> RecordFile::finish() {
    {
        const std::lock_guard lock{mutex_};
        ending_ = true;
    }
    changed_.notify_one();
    if (thread_.joinable()) thread_.join();
    return fault_.empty() ? Result<void>{} : wrong(fault_);
}

void RecordFile::run() {
    for (bool last = false; !last;) {
        std::string bytes;
        {
            std::unique_lock lock{mutex_};
            changed_.wait_for(lock, between_syncs, [this] { return ending_; });
            last = ending_;
            bytes.swap(waiting_);
        }
        if (bytes.empty()) continue;
        std::string wrong = put(bytes);
        if (wrong.empty()) continue;
        const std::lock_guard lock{mutex_};
        fault_ = std::move(wrong);
        return;
    }
}

std::string RecordFile::put(const std::string& bytes) const {
    for (std::size_t done = 0; done < bytes.size();) {
        const ssize_t written = ::write(descriptor_, bytes.data() + done, bytes.size() - done);
        if (written < 0 && errno == EINTR) continue;
        if (written < 0)
            return "'" + name_ + "' cannot be written: " + std::strerror(errno) +
                   "; its contents up to that point are good";
        done += static_cast<std::size_t>(written);
    }
    if (::fdatasync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) // a pipe has no disk
        return "'" + name_ + "' does not reach its disk: " + std::strerror(errno);
    return {};
}

Result<void> stop_recording(const std::string& name) {
    const int descriptor = ::open(name.c_str(), O_RDWR | O_CLOEXEC);
    if (descriptor < 0)
        return wrong("'" + name + "' cannot be opened: " + std::strerror(errno) +
                     "; name the file of 'report start'");
    struct flock lock = recorders_lock();
    const bool asked = ::fcntl(descriptor, F_GETLK, &lock) == 0;
    ::close(descriptor);
    if (!asked || lock.l_type == F_UNLCK) return wrong("nobody records into '" + name + "'");
    if (!is_recorders(
            lock)) // a process number of 0 or -1, as an argument of kill(), would mean all processes
        return wrong("'" + name + "' is locked by something that is no 'report start'; end that instead");
    if (::kill(lock.l_pid, SIGTERM) != 0)
        return wrong("process " + std::to_string(lock.l_pid) + ", which records into '" + name +
                     "', cannot be asked to end: " + std::strerror(errno));
    return {};
}

} // namespace tappet::browser
