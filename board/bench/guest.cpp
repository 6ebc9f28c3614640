// SPDX-License-Identifier: Apache-2.0
// Telling the host, giving up, and small files of the kernel.
#include "board/bench/guest.hpp"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <thread>

#include <fcntl.h>
#include <sys/mount.h>
#include <sys/reboot.h>
#include <sys/stat.h>
#include <unistd.h>

namespace tappet::bench {

Results results;

void Results::write_all(std::string_view bytes) {
    while (descriptor_ >= 0 && !bytes.empty()) {
        const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
        if (count < 0 && errno == EINTR) {
            continue;
        }
        if (count <= 0) {
            return;
        }
        bytes.remove_prefix(static_cast<std::size_t>(count));
    }
}

void power_off() {
    ::sync();
    ::reboot(RB_POWER_OFF);
    std::abort();
}

void give_up(const std::string& what) {
    const std::string reason = what + ": " + std::strerror(errno);
    std::fprintf(stderr, "bench init: %s\n", reason.c_str());
    results.line("fault " + reason);
    power_off();
}

void pause_for(std::chrono::milliseconds time) { std::this_thread::sleep_for(time); }

void make_folder(const std::string& path) {
    for (std::size_t at = path.find('/', 1); at != std::string::npos; at = path.find('/', at + 1)) {
        ::mkdir(path.substr(0, at).c_str(), 0755);
    }
    ::mkdir(path.c_str(), 0755);
}

bool write_text(const std::string& path, const std::string& text) {
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor < 0) {
        return false;
    }
    const ssize_t count = ::write(descriptor, text.data(), text.size());
    const int error = errno;
    ::close(descriptor);
    errno = error;
    return count == static_cast<ssize_t>(text.size());
}

std::string read_line(const std::string& path) {
    std::ifstream file(path);
    std::string line;
    std::getline(file, line);
    return line;
}

void mount_at(const char* type, const std::string& path) {
    make_folder(path);
    if (::mount(type, path.c_str(), type, 0, nullptr) != 0 && errno != EBUSY) {
        give_up("mount " + path);
    }
}

} // namespace tappet::bench
