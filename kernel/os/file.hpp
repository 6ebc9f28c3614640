// A whole file read into memory that is already allocated.
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

/// Reads a file. Not real-time; uses no heap. A file that does not fit is not read in part: too_large.
[[nodiscard]] FileText read_file(const char* path, std::span<char> into) noexcept;

} // namespace tappet::os
