// Text to the terminal or a file, unbuffered, without stdio and its heap.
#pragma once

#include <string_view>

namespace tappet::os {

/// To standard output. May block: not real-time.
void print(std::string_view text) noexcept;
/// To an open file; false when not all of it could be written.
bool write_all(int file, std::string_view text) noexcept;
/// Replaces a file's contents at once: an old or a new file is there, never half of one. False: `path` cannot
/// be written.
bool replace_file(const char* path, std::string_view text) noexcept;

} // namespace tappet::os
