// SPDX-License-Identifier: Apache-2.0
// Small files of the kernel, mounts, children, and the end of the box.
#include "board/init/system.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>

#include <dirent.h>
#include <fcntl.h>
#include <sys/mount.h>
#include <sys/reboot.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tappet::init {

std::unexpected<std::string> failed(const std::string& what) {
    return std::unexpected(what + ": " + std::strerror(errno));
}

void close_it(int descriptor) {
    const int error = errno;
    if (descriptor >= 0) ::close(descriptor);
    errno = error;
}

void pause_for(std::chrono::milliseconds time) { std::this_thread::sleep_for(time); }

void make_folder(const std::string& path) {
    for (std::size_t at = path.find('/', 1); at != std::string::npos; at = path.find('/', at + 1))
        ::mkdir(path.substr(0, at).c_str(), 0755);
    ::mkdir(path.c_str(), 0755);
}

bool write_text(const std::string& path, std::string_view text) {
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor < 0) return false;
    const ssize_t count = ::write(descriptor, text.data(), text.size());
    close_it(descriptor);
    return count == static_cast<ssize_t>(text.size());
}

std::string read_text(const std::string& path) {
    std::string text;
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    char piece[4096];
    for (ssize_t count = 0; descriptor >= 0 && (count = ::read(descriptor, piece, sizeof piece)) > 0;)
        text.append(piece, static_cast<std::size_t>(count));
    close_it(descriptor);
    return text;
}

std::string read_line(const std::string& path) {
    std::string text = read_text(path);
    text.resize(std::min(text.find('\n'), text.size()));
    return text;
}

std::vector<std::string> names_in(const std::string& folder) {
    std::vector<std::string> names;
    if (DIR* open = ::opendir(folder.c_str())) {
        while (const dirent* entry = ::readdir(open))
            if (entry->d_name[0] != '.') names.emplace_back(entry->d_name);
        ::closedir(open);
    }
    return names;
}

Done mount_kernel_files() {
    struct Place {
        const char* type;
        const char* path;
    };
    for (const auto& [type, path] :
         {Place{"devtmpfs", "/dev"}, Place{"proc", "/proc"}, Place{"sysfs", "/sys"},
          Place{"tmpfs", "/dev/shm"}, Place{"tmpfs", "/tmp"}, Place{"tmpfs", "/run"},
          Place{"devpts", "/dev/pts"}}) {
        make_folder(path);
        if (::mount(type, path, type, 0, nullptr) != 0 && errno != EBUSY)
            return failed(std::string("mount ") + path);
    }
    return {};
}

std::expected<int, std::string> stop_throttling() {
    if (!write_text("/proc/sys/kernel/sched_rt_runtime_us", "-1"))
        return failed("write -1 to /proc/sys/kernel/sched_rt_runtime_us");
    const char* const debug_files = "/sys/kernel/debug";
    const bool mounted =
        ::mount("debugfs", debug_files, "debugfs", MS_NOSUID | MS_NODEV | MS_NOEXEC, nullptr) == 0;
    if (!mounted && errno != EBUSY && errno != ENODEV && errno != ENOENT) // a kernel may have none
        return failed(std::string("mount ") + debug_files);
    const std::string servers = std::string(debug_files) + "/sched/fair_server";
    int stopped = 0;
    for (const std::string& processor : names_in(servers))
        if (write_text(servers + "/" + processor + "/runtime", "0"))
            ++stopped;
        else if (errno != EBUSY) // the processor is offline
            return failed("write 0 to " + servers + "/" + processor + "/runtime");
    if (stopped == 0 && mounted) ::umount(debug_files); // nobody else needs it
    return stopped;
}

std::expected<pid_t, std::string> start(const std::vector<std::string>& words, int output,
                                        const std::string& cure) {
    const pid_t pid = ::fork();
    if (pid < 0) return failed("fork");
    if (pid > 0) return pid;
    ::setsid();
    ::signal(SIGPIPE, SIG_DFL);
    sigset_t none;
    ::sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
    ::dup2(output, STDOUT_FILENO);
    ::dup2(output, STDERR_FILENO);
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    ::execvp(arguments[0], arguments.data());
    ::dprintf(STDERR_FILENO, "cannot run '%s': %s; %s\n", words[0].c_str(), std::strerror(errno),
              cure.c_str());
    ::_exit(127);
}

int to_exit_code(int status) { return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status); }

void reap(const std::function<void(pid_t, int)>& ended) {
    int status = 0;
    for (pid_t pid = ::waitpid(-1, &status, WNOHANG); pid > 0; pid = ::waitpid(-1, &status, WNOHANG))
        ended(pid, to_exit_code(status));
}

// The name may contain anything; state and parent follow it.
std::vector<pid_t> children_of(pid_t parent) {
    std::vector<pid_t> children;
    for (const std::string& name : names_in("/proc")) {
        const pid_t pid = std::atoi(name.c_str());
        const std::string text = pid > 0 ? read_text("/proc/" + name + "/stat") : std::string{};
        const std::size_t end = text.rfind(')');
        int its_parent = 0;
        if (end != std::string::npos && std::sscanf(text.c_str() + end + 1, " %*c %d", &its_parent) == 1 &&
            its_parent == parent)
            children.push_back(pid);
    }
    return children;
}

void reset_box() {
    ::reboot(RB_AUTOBOOT);
    std::abort();
}

namespace {

[[noreturn]] void leave(int how) {
    ::sync();
    ::reboot(how);
    std::abort();
}

} // namespace

void power_off() { leave(RB_POWER_OFF); }
void restart_box() { leave(RB_AUTOBOOT); }

} // namespace tappet::init
