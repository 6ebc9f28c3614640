// The kernel's files in /proc and /sys, read without a heap, and parsers for the two formats in use.
#pragma once

#include "kernel/base/text.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace tappet::os {

/// The first 4 kB of a file: the files in use are shorter. Not real-time.
struct SystemFile {
    static constexpr std::size_t capacity = 4096;
    char characters[capacity] = {};
    std::size_t length = 0;
    bool readable = false;
    int error = 0; ///< errno of the failed read

    /// `root` is a prefix of `path`: empty, or the directory tree of a test.
    SystemFile(std::string_view root, const Sentence& path) noexcept;
    /// Returns the text without the last line's end.
    [[nodiscard]] std::string_view text() const noexcept;
};

/// Returns the number after a key: number_after("VmLck:\t 64 kB", "VmLck:", 10) is 64.
std::optional<std::uint64_t> number_after(std::string_view text, std::string_view key, int base) noexcept;

/// Returns whether one of the kernel's lists, as "0-3,6", contains a number. A malformed list contains none.
bool list_has(std::string_view list, int wanted) noexcept;

} // namespace tappet::os
