// Reads with read, and parses with from_chars.
#include "kernel/os/system_file.hpp"

#include <cerrno>
#include <charconv>

#include <fcntl.h>
#include <unistd.h>

namespace tappet::os {

SystemFile::SystemFile(std::string_view root, const Sentence& path) noexcept {
    const Sentence full{root, path};
    const int file = open(full.characters, O_RDONLY | O_CLOEXEC);
    if (file < 0) {
        error = errno;
        return;
    }
    while (length < capacity) {
        const auto got = read(file, characters + length, capacity - length);
        if (got < 0) {
            error = errno;
            break;
        }
        readable = true;
        if (got == 0) break;
        length += static_cast<std::size_t>(got);
    }
    close(file);
}

std::string_view SystemFile::text() const noexcept {
    std::string_view all{characters, length};
    while (!all.empty() && (all.back() == '\n' || all.back() == ' ')) all.remove_suffix(1);
    return all;
}

std::optional<std::uint64_t> number_after(std::string_view text, std::string_view key, int base) noexcept {
    const std::size_t at = text.find(key);
    if (at == std::string_view::npos) return std::nullopt;
    text.remove_prefix(at + key.size());
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
    return error == std::errc{} ? std::optional{value} : std::nullopt;
}

bool list_has(std::string_view list, int wanted) noexcept {
    const char* at = list.data();
    const char* const end = at + list.size();
    while (at < end) {
        int low = 0;
        const auto first = std::from_chars(at, end, low);
        if (first.ec != std::errc{}) return false;
        int high = low;
        at = first.ptr;
        if (at < end && *at == '-') {
            const auto second = std::from_chars(at + 1, end, high);
            if (second.ec != std::errc{}) return false;
            at = second.ptr;
        }
        if (wanted >= low && wanted <= high) return true;
        if (at < end && *at != ',') return false;
        if (at < end) ++at;
    }
    return false;
}

} // namespace tappet::os
