// What the kernel answers in /proc and /sys, read without a heap, and the two forms of it that are looked
// into.
#pragma once

#include "kernel/base/text.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace tappet::os {

/// The first 4 kB of a file: the answers looked at are shorter. Not real-time.
struct SystemFile {
    static constexpr std::size_t capacity = 4096;
    char characters[capacity] = {};
    std::size_t length = 0;
    bool readable = false;
    int error = 0; ///< errno of what kept it from being read

    /// `root` stands before `path`; empty, or a made-up tree of a test.
    SystemFile(std::string_view root, const Sentence& path) noexcept;
    /// Without the last line's end.
    [[nodiscard]] std::string_view text() const noexcept;
};

/// The number after a key: number_after("VmLck:\t 64 kB", "VmLck:", 10) is 64.
std::optional<std::uint64_t> number_after(std::string_view text, std::string_view key, int base) noexcept;

/// Whether one of the kernel's lists, as "0-3,6", has a number. A list that is none has nothing.
bool list_has(std::string_view list, int wanted) noexcept;

} // namespace tappet::os
