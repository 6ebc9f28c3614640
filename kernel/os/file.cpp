// Reads a file with read(2), and continues after interruptions.
#include "kernel/os/file.hpp"

#include <cerrno>

#include <fcntl.h>
#include <unistd.h>

namespace tappet::os {

FileText read_file(const char* path, std::span<char> into) noexcept {
    const int file = open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0) return {errno == ENOENT ? FileRead::missing : FileRead::unreadable, 0};
    FileText text{FileRead::too_large, 0};
    while (text.length < into.size()) {
        const ssize_t got = read(file, into.data() + text.length, into.size() - text.length);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) {
            text.result = got == 0 ? FileRead::good : FileRead::unreadable;
            break;
        }
        text.length += static_cast<std::size_t>(got);
    }
    close(file);
    return text;
}

} // namespace tappet::os
