// The host's watch over a machine's cycles in one thread. Real-time code: the first use of the heap, of a
// lock or of the system in each cycle is recorded with its caller. All code: a fault of the processor and a
// cycle that does not end are told with activity and function, and end the program. A firmware does not link
// it: its heap is sealed, a compiler has checked its sources, and its guardian does the rest. Linux' syscall
// user dispatch shows the system calls (x86-64).
#pragma once

#include "kernel/base/text.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace tappet::os::host_watch {

/// A place in the program that used something that may block.
struct Use {
    std::string_view what{};     ///< "malloc", "pthread_mutex_lock", "the system call write"
    std::string_view activity{}; ///< the first whose cycle did it
    std::uintptr_t caller = 0;   ///< address in the program's own code
    std::uint64_t cycles = 0;    ///< that did it first
};
inline constexpr std::size_t max_uses = 16; ///< further places are counted only

// Weak: absent in a program that does not link the watch. All are for the thread that called prepare().

/// Prepares the calling thread for `machine`, which outlives the program. A cycle that has used
/// `longest_cycle_s` of processor time counts as one that does not end. Returns false where the kernel cannot
/// show system calls; the rest is watched all the same. Not real-time.
[[gnu::weak]] bool prepare(std::string_view machine, int longest_cycle_s = 10) noexcept;
/// Surround a cycle of `activity`, which outlives the program's end.
[[gnu::weak]] void enter(std::string_view activity, bool is_real_time) noexcept;
[[gnu::weak]] void leave() noexcept;
[[gnu::weak]] std::span<const Use> uses() noexcept;
/// Cycles in which any place did so, also those without a record.
[[gnu::weak]] std::uint64_t cycles() noexcept;
/// Names the place as "in <function>" or "in a function of component type <type>", if the program exports its
/// names. Not real-time.
[[gnu::weak]] Sentence place_of(const Use& use) noexcept;

inline bool is_linked() noexcept { return &prepare != nullptr; }

} // namespace tappet::os::host_watch
