// Memory that is present: locked, touched before arming, with painted stacks so that their depth can be
// measured afterwards.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/text.hpp"

#include <cstddef>
#include <expected>
#include <span>

namespace tappet::os {

/// Locks all memory with mlockall, mapped now and later. The error names the cure. Not real-time.
std::expected<void, Sentence> lock_memory() noexcept;
void unlock_memory() noexcept;
/// Returns true between lock_memory() and unlock_memory().
[[nodiscard]] bool memory_is_locked() noexcept TAPPET_REALTIME;

std::size_t page_bytes() noexcept;

/// Writes to every page its present contents, so that each page is mapped, private and writable. The range
/// must be writable, and no other thread may write to it meanwhile. Not real-time.
void touch(std::span<std::byte> range) noexcept;

/// Maps the calling thread's next `bytes` of stack: at least a page less than its stack has left. Not
/// real-time.
void touch_stack(std::size_t bytes) noexcept;

/// Returns the guard: the lowest whole pages of a stack, which are closed while a thread runs on it, so that
/// an overflow faults there. Frames larger than a page touch each of their pages in turn, except those of the
/// C library. So a stack of 64 KiB or more, on which code that prints may run, has a guard of 16 KiB, a
/// smaller one has one page. Empty: the stack is smaller than that.
[[nodiscard]] std::size_t stack_guard_bytes(std::size_t stack_bytes) noexcept;
[[nodiscard]] std::span<std::byte> stack_guard(std::span<std::byte> stack) noexcept;

/// Paints a thread's stack before the thread starts; the overwritten paint shows how deep it went. Painting
/// also touches it. Not real-time.
void paint_stack(std::span<std::byte> stack) noexcept;
/// Returns the deepest use in bytes, counted from the stack's top, without its guard. The result is at least
/// the real use, less an odd word that happens to equal the paint. Takes time in proportion to the unused
/// part: not real-time.
[[nodiscard]] std::size_t stack_high_water_bytes(std::span<const std::byte> stack) noexcept;

/// Returns the memory of this process that is present, in bytes; 0 without /proc. Not real-time.
[[nodiscard]] std::size_t rss_bytes() noexcept;

} // namespace tappet::os
