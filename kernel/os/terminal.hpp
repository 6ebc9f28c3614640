// Text to the terminal or a file, unbuffered, without stdio and its heap. From never_wait() on nobody who
// reads it, or does not, can hold up who writes.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace tappet::os {

/// To standard output. Waits for who reads it until never_wait(): not real-time.
void print(std::string_view text) noexcept;
/// To an open file; false when not all of it could be written. To standard output and standard error it waits
/// until never_wait() only; from then on true also when the rest of a text waits here for room.
bool write_all(int file, std::string_view text) noexcept;

/// For a machine that may move: a text for standard output or standard error is written whole, or dropped and
/// counted when its reader is slow, stopped (Ctrl-S) or gone. Once there is room again, a line says how many
/// were dropped; of a text beyond 4096 bytes the end may be. For the rest of the process; it may be called
/// again, when these files were replaced. A regular file is trusted not to wait. Not real-time.
void never_wait() noexcept;
/// Texts dropped since never_wait(). Any thread.
[[nodiscard]] std::uint64_t dropped_texts() noexcept;

/// Replaces a file's contents at once and for good: an old or a new file is there, never half of one, and
/// after true the new one, though the power fails. False: `path` cannot be written; nothing else stays
/// behind.
bool replace_file(const char* path, std::span<const std::string_view> pieces) noexcept;
inline bool replace_file(const char* path, std::string_view text) noexcept {
    return replace_file(path, std::span{&text, 1});
}

} // namespace tappet::os
