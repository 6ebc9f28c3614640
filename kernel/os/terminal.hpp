// Text to the terminal or a file, unbuffered, without stdio and its heap. From never_wait() on no reader can
// delay the writer.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace tappet::os {

/// Prints to standard output. Waits for its reader until never_wait(): not real-time.
void print(std::string_view text) noexcept;
/// Writes to an open file. Returns false when a part could not be written. For standard output and standard
/// error it waits only until never_wait(); from then on it also returns true when the rest of a text is kept
/// here until there is room.
bool write_all(int file, std::string_view text) noexcept;

/// Returns whether print() could write every text so far. For programs whose output is their purpose.
[[nodiscard]] bool has_printed_all() noexcept;

/// For a machine that may move: from here on a text for standard output or standard error is written whole,
/// or dropped and counted when its reader is slow, stopped (Ctrl-S) or gone. Once there is room again, a line
/// reports how many were dropped; the end of a text beyond 4096 bytes may be dropped. For the rest of the
/// process; call it again when these files were replaced. A regular file is trusted not to wait. Not
/// real-time.
void never_wait() noexcept;
/// Returns the number of texts dropped since never_wait(). Any thread.
[[nodiscard]] std::uint64_t dropped_texts() noexcept;

/// Replaces a file's contents atomically and durably: there is the old or the new file, never a part of one;
/// after true the new one, even if the power fails. A link leads to the file that is replaced, which keeps
/// its mode and owner; a device or a pipe is written to. False: `path` cannot be written; nothing is left
/// behind.
bool replace_file(const char* path, std::span<const std::string_view> pieces) noexcept;
inline bool replace_file(const char* path, std::string_view text) noexcept {
    return replace_file(path, std::span{&text, 1});
}

} // namespace tappet::os
