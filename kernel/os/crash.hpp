// SPDX-License-Identifier: Apache-2.0
// A fault of the program itself (SEGV, BUS, FPE, ILL, TRAP, SYS, ABRT): noted, told, and nothing of that
// thread goes on.
#pragma once

#include "kernel/base/text.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tappet::os {

/// What the kernel said when it took the thread off. The first crash of a process counts.
struct CrashNote {
    std::atomic<std::uint32_t> state{0}; ///< 0: none, 1: one thread is writing it, 2: it is complete
    std::int32_t signal = 0;
    std::int32_t thread = 0;
    std::uint64_t address = 0;     ///< of the memory that was wanted; of ABRT nothing
    std::uint64_t instruction = 0; ///< where the thread stood
    std::uint64_t stack_bytes = 0; ///< of its stack, which was used up; 0: it was not that
    std::array<char, 16> thread_name{};
    /// Where the calls on its stack return to, the innermost first, 0 after the last. Found by looking for
    /// what follows a call: some may be left over from calls that had returned.
    std::array<std::uint64_t, 16> returns{};

    [[nodiscard]] bool is_complete() const noexcept { return state.load(std::memory_order_acquire) == 2; }
    /// "signal SEGV at instruction 0x.. for address 0x.. in thread \"motion\""
    [[nodiscard]] Sentence describe() const;
};

/// "SEGV" of 11; "signal" of what has no name here.
[[nodiscard]] std::string_view signal_name(int number) noexcept;

/// From here on a crash of any thread of kernel/os/thread.hpp, and of this one, is written to `note`, which
/// whoever acts on it can read; `told` is a descriptor that one word is then written to (an eventfd). The
/// thread sleeps: whoever was told ends the process. After `patience_ms` nobody did, and the signal ends it.
/// Handlers run on a stack of their own. Not real-time.
void on_crash(CrashNote& note, int told, int patience_ms) noexcept;
/// The calling thread's handlers run on that stack: each thread says so at its begin, and what its own is.
/// Without on_crash() it is unused.
void take_crashes_on_own_stack(std::span<std::byte> stack = {}) noexcept;

} // namespace tappet::os
