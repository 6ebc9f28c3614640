// SPDX-License-Identifier: Apache-2.0
// Signal handlers that call nothing but what a handler may.
#include "kernel/os/crash.hpp"

#include <csignal>
#include <cstddef>
#include <ctime>

#include <sys/prctl.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>

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

// One for all threads: who crashes second finds the first one's note, and sleeps. Should it overwrite what
// the first one stands on, the kernel ends the process, which whoever acts learns as well.
alignas(64) constinit std::array<std::byte, 32 * 1024> own_stack{};

std::uint64_t instruction_of(const ucontext_t& context) noexcept {
#if defined(__x86_64__)
    return static_cast<std::uint64_t>(context.uc_mcontext.gregs[REG_RIP]);
#elif defined(__aarch64__)
    return context.uc_mcontext.pc;
#else
#error "say where this processor keeps the place of an interrupted thread"
#endif
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
        prctl(PR_GET_NAME, note.thread_name.data());
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
    return text.add(" in thread \"").add(std::string_view{thread_name.data()}).add("\"");
}

void take_crashes_on_own_stack() noexcept {
    if (told.note == nullptr) return; // a sanitizer has a stack for its own handlers
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
