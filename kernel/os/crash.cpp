// SPDX-License-Identifier: Apache-2.0
// Signal handlers that call only functions permitted in a handler.
#include "kernel/os/crash.hpp"

#include "kernel/os/memory.hpp"

#include <algorithm>
#include <csignal>
#include <cstddef>
#include <ctime>

#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <ucontext.h>
#include <unistd.h>

/// The begin and the end of the program's code, as named by the linker.
extern "C" const unsigned char __executable_start[], etext[]; // NOLINT

namespace tappet::os {

namespace {

struct Named {
    int number;
    std::string_view name;
};
constexpr Named faults[] = {{SIGSEGV, "SEGV"}, {SIGBUS, "BUS"},   {SIGFPE, "FPE"}, {SIGILL, "ILL"},
                            {SIGTRAP, "TRAP"}, {SIGABRT, "ABRT"}, {SIGSYS, "SYS"}};

struct Told {
    CrashNote* note = nullptr;
    int descriptor = -1;
    int patience_ms = 0;
};
constinit Told told{};

// One stack for all threads: the thread that crashes second finds the first one's note, and sleeps. If it
// overwrites the stack in use by the first one, the kernel ends the process, which the guardian sees as well.
alignas(64) constinit std::array<std::byte, 32 * 1024> own_stack{};

/// The stack of the calling thread: the addresses of its guard, and its size.
struct OwnStack {
    std::uint64_t guard = 0, guard_end = 0, bytes = 0;
};
constinit thread_local OwnStack own{};

#if defined(__x86_64__)
std::uint64_t instruction_of(const ucontext_t& context) noexcept {
    return static_cast<std::uint64_t>(context.uc_mcontext.gregs[REG_RIP]);
}
std::uint64_t stack_of(const ucontext_t& context) noexcept {
    return static_cast<std::uint64_t>(context.uc_mcontext.gregs[REG_RSP]);
}
/// Returns whether the instruction before is a call: direct, or by a register or memory in the usual lengths.
bool follows_call(const unsigned char* at) noexcept {
    const auto calls = [&](int back) { return at[-back] == 0xff && (at[1 - back] & 0x38) == 0x10; };
    return at[-5] == 0xe8 || calls(2) || calls(3) || calls(4) || calls(6) || calls(7);
}
#elif defined(__aarch64__)
std::uint64_t instruction_of(const ucontext_t& context) noexcept { return context.uc_mcontext.pc; }
std::uint64_t stack_of(const ucontext_t& context) noexcept { return context.uc_mcontext.sp; }
bool follows_call(const unsigned char* at) noexcept {
    std::uint32_t before = 0;
    __builtin_memcpy(&before, at - 4, 4);
    return (before & 0xfc000000u) == 0x94000000u || (before & 0xfffffc1fu) == 0xd63f0000u;
}
#else
#error "say where this processor keeps the place and the stack of an interrupted thread, and what calls"
#endif

// Frame pointers would tell calls from left-over return addresses, but would cost every function a register.
void note_returns(CrashNote& note, std::uint64_t stack) noexcept {
    // The kernel reads the stack: a wild stack pointer does not stop it. A missing page ends the reading.
    constexpr std::size_t most = 8192, page = 4096;
    static constinit std::array<std::uint64_t, most / 8> words{};
    std::size_t read = 0;
    while (read < most) {
        const std::uint64_t from = (stack & ~std::uint64_t{7}) + read;
        const std::size_t piece = std::min(most - read, page - from % page);
        const iovec into{words.data() + read / 8, piece}, out{reinterpret_cast<void*>(from), piece};
        if (syscall(SYS_process_vm_readv, getpid(), &into, 1, &out, 1, 0) != static_cast<long>(piece)) break;
        read += piece;
    }
    std::size_t found = 0;
    for (std::size_t w = 0; w < read / 8 && found < note.returns.size(); ++w) {
        const auto* at = reinterpret_cast<const unsigned char*>(words[w]);
        if (at > __executable_start + 8 && at < etext && follows_call(at)) note.returns[found++] = words[w];
    }
}

struct Hexadecimal {
    std::array<char, 18> characters{'0', 'x'};
    std::size_t length = 2;
    explicit Hexadecimal(std::uint64_t number) noexcept {
        int shift = 60;
        while (shift > 0 && number >> shift == 0) shift -= 4;
        for (; shift >= 0; shift -= 4) characters[length++] = "0123456789abcdef"[number >> shift & 15u];
    }
    [[nodiscard]] std::string_view view() const noexcept { return {characters.data(), length}; }
};

void sleep_ms(int milliseconds) noexcept {
    timespec left{milliseconds / 1000, milliseconds % 1000 * 1'000'000L};
    while (nanosleep(&left, &left) != 0) {
    }
}

void take(int number, siginfo_t* facts, void* context) noexcept {
    CrashNote& note = *told.note;
    std::uint32_t none = 0;
    if (note.state.compare_exchange_strong(none, 1)) {
        note.signal = number;
        note.thread = static_cast<std::int32_t>(syscall(SYS_gettid));
        note.address = facts->si_code <= 0 ? 0 : // another process, or abort()
                           reinterpret_cast<std::uint64_t>(facts->si_addr);
        note.instruction = instruction_of(*static_cast<const ucontext_t*>(context));
        // A wild pointer may point there as well, so the stack pointer decides. A leaf function may use 128
        // bytes below it.
        const std::uint64_t stack = stack_of(*static_cast<const ucontext_t*>(context));
        if (note.address >= own.guard && note.address < own.guard_end && stack < own.guard_end + 128)
            note.stack_bytes = own.bytes;
        prctl(PR_GET_NAME, note.thread_name.data());
        note_returns(note, stack);
        note.state.store(2, std::memory_order_release);
        const std::uint64_t one = 1;
        [[maybe_unused]] const auto n = write(told.descriptor, &one, sizeof one);
    }
    sleep_ms(told.patience_ms);
    struct sigaction action{};
    action.sa_handler = SIG_DFL;
    sigaction(number, &action, nullptr);
    raise(number); // delivered when this handler returns
}

} // namespace

std::string_view signal_name(int number) noexcept {
    for (const Named& each : faults)
        if (each.number == number) return each.name;
    switch (number) {
    case SIGKILL: return "KILL";
    case SIGTERM: return "TERM";
    case SIGINT: return "INT";
    default: return "signal";
    }
}

Sentence CrashNote::describe() const {
    Sentence text{signal_name(signal), " at instruction ", Hexadecimal{instruction}.view()};
    if (address != 0) text.add(" for address ").add(Hexadecimal{address}.view());
    text.add(" in thread \"").add(std::string_view{thread_name.data()}).add("\"");
    if (stack_bytes != 0)
        text.add(", whose stack of ")
            .add(stack_bytes)
            .add(" bytes is used up; an activity's row gives it more by stack(...)");
    return text;
}

void take_crashes_on_own_stack(std::span<std::byte> of_thread) noexcept {
    if (told.note == nullptr) return; // a sanitizer has a stack for its own handlers
    const std::span guard = stack_guard(of_thread);
    const auto begin = reinterpret_cast<std::uint64_t>(guard.data());
    own = {begin, begin + guard.size(), of_thread.size()};
    stack_t stack{};
    stack.ss_sp = own_stack.data();
    stack.ss_size = own_stack.size();
    sigaltstack(&stack, nullptr);
}

void on_crash(CrashNote& note, int descriptor, int patience_ms) noexcept {
    told = {&note, descriptor, patience_ms};
    take_crashes_on_own_stack();
    struct sigaction action{};
    action.sa_sigaction = &take;
    action.sa_flags = SA_SIGINFO | SA_ONSTACK;
    sigfillset(&action.sa_mask);
    for (const Named& each : faults) sigaction(each.number, &action, nullptr);
}

} // namespace tappet::os
