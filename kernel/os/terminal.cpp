// Writes whole texts by write(2), whatever interrupts it.
#include "kernel/os/terminal.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include <fcntl.h>
#include <unistd.h>

namespace tappet::os {

bool write_all(int file, std::string_view text) noexcept {
    while (!text.empty()) {
        const ssize_t written = write(file, text.data(), text.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return false;
        text.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
}

void print(std::string_view text) noexcept { static_cast<void>(write_all(STDOUT_FILENO, text)); }

bool replace_file(const char* path, std::string_view text) noexcept {
    char beside[4096];
    const std::size_t length = std::strlen(path);
    if (length + 5 > sizeof beside) return false;
    std::memcpy(beside, path, length);
    std::memcpy(beside + length, ".new", 5);
    const int file = open(beside, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (file < 0) return false;
    const bool written = write_all(file, text) && fsync(file) == 0;
    close(file);
    return written && rename(beside, path) == 0;
}

} // namespace tappet::os
