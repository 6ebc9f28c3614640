// Memory that is there: locked, touched before arming, its stacks painted so that their depth can be read
// afterwards.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/text.hpp"

#include <cstddef>
#include <expected>
#include <span>

namespace tappet::os {

/// mlockall, what is mapped now and later. The error names the cure. Not real-time.
std::expected<void, Sentence> lock_memory() noexcept;
void unlock_memory() noexcept;
/// True between the two.
[[nodiscard]] bool memory_is_locked() noexcept TAPPET_REALTIME;

std::size_t page_bytes() noexcept;

/// Writes to every page what stands there already, so that each is mapped, private and writable. The range is
/// writable and no other thread writes to it meanwhile. Not real-time.
void touch(std::span<std::byte> range) noexcept;

/// Maps the calling thread's next `bytes` of stack. Less than its stack has left, a page apart. Not
/// real-time.
void touch_stack(std::size_t bytes) noexcept;

/// The lowest whole pages of a stack, which are closed while a thread runs on it: who runs over the rest
/// faults there. Frames that are larger than a page touch each of their pages in turn, but for those of the C
/// library: from 64 KiB on, where code that prints may run, a stack has a guard of 16 KiB, else of one page.
/// Empty: the stack is smaller.
[[nodiscard]] std::size_t stack_guard_bytes(std::size_t stack_bytes) noexcept;
[[nodiscard]] std::span<std::byte> stack_guard(std::span<std::byte> stack) noexcept;

/// A stack given to a thread is painted before the thread starts; the paint that is gone shows how deep it
/// went. Painting touches it too. Not real-time.
void paint_stack(std::span<std::byte> stack) noexcept;
/// The deepest use in bytes, counted from the stack's top, its guard left out. What is found is at least what
/// was used, less the odd word that happens to equal the paint. Takes time in proportion to what was not
/// used: not real-time.
[[nodiscard]] std::size_t stack_high_water_bytes(std::span<const std::byte> stack) noexcept;

/// Memory of this process that is present; 0 when /proc is not there. Not real-time.
[[nodiscard]] std::size_t rss_bytes() noexcept;

} // namespace tappet::os
