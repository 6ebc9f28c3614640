// SPDX-License-Identifier: Apache-2.0
// A fault of the program itself (SEGV, BUS, FPE, ILL, TRAP, SYS, ABRT): noted, reported, and its thread
// stopped.
#pragma once

#include "kernel/base/text.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tappet::os {

/// The kernel's facts about a crash. The first crash of a process counts.
struct CrashNote {
    std::atomic<std::uint32_t> state{0}; ///< 0: none, 1: one thread is writing it, 2: it is complete
    std::int32_t signal = 0;
    std::int32_t thread = 0;
    std::uint64_t address = 0;     ///< address of the memory access; 0 for ABRT
    std::uint64_t instruction = 0; ///< address of the interrupted instruction
    std::uint64_t stack_bytes = 0; ///< size of its stack, if that overflowed; 0: it did not
    std::array<char, 16> thread_name{};
    /// Return addresses of the calls on its stack, the innermost first, 0 after the last. Found by a search
    /// for addresses after a call instruction: some may be left over from calls that had returned.
    std::array<std::uint64_t, 16> returns{};

    [[nodiscard]] bool is_complete() const noexcept { return state.load(std::memory_order_acquire) == 2; }
    /// "signal SEGV at instruction 0x.. for address 0x.. in thread \"motion\""
    [[nodiscard]] Sentence describe() const;
};

/// Returns the name of a signal: "SEGV" for 11; "signal" if it has no name here.
[[nodiscard]] std::string_view signal_name(int number) noexcept;

/// Handles crashes from here on. A crash of any thread of kernel/os/thread.hpp, and of this one, is written
/// to `note`, which the guardian can read. `told` is a descriptor (an eventfd) to which one word is then
/// written. The thread sleeps until the guardian ends the process; if nobody did after `patience_ms`, the
/// signal ends it. Handlers run on a stack of their own. Not real-time.
void on_crash(CrashNote& note, int told, int patience_ms) noexcept;
/// Makes the calling thread's handlers run on the handlers' stack. Each thread calls it at its begin, with
/// its own stack as `stack`. Without on_crash() it has no effect.
void take_crashes_on_own_stack(std::span<std::byte> stack = {}) noexcept;

} // namespace tappet::os
