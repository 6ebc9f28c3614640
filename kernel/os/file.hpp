// A whole file read into memory that is there already.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace tappet::os {

enum class FileRead : std::uint8_t { good, missing, unreadable, too_large };

struct FileText {
    FileRead result = FileRead::unreadable;
    std::size_t length = 0;
};

/// Not real-time; takes no heap. What does not fit is not read in part: too_large.
[[nodiscard]] FileText read_file(const char* path, std::span<char> into) noexcept;

} // namespace tappet::os
