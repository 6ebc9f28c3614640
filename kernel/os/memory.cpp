// Locking, touching and painting, with mlockall and plain writes.
#include "kernel/os/memory.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include <alloca.h>
#include <fcntl.h>
#include <sys/auxv.h>
#include <sys/mman.h>
#include <unistd.h>

namespace tappet::os {

namespace {

constinit std::atomic<bool> locked{false};

// A word unlike addresses and small numbers.
constexpr std::uint64_t paint = 0x7a99e77a99e77a99u;

[[gnu::noinline]] void touch_below(std::size_t bytes) noexcept {
    auto* area = static_cast<volatile std::byte*>(alloca(bytes));
    const std::size_t page = page_bytes();
    // From the top down: the kernel grows the main thread's stack only near its present end.
    for (std::size_t left = bytes; left > 0; left -= std::min(left, page)) area[left - 1] = std::byte{0};
    area[0] = std::byte{0};
}

} // namespace

std::expected<void, Sentence> lock_memory() noexcept {
    if (mlockall(MCL_CURRENT | MCL_FUTURE) == 0) {
        locked.store(true, std::memory_order_release);
        return {};
    }
    const int error = errno;
    return std::unexpected(Sentence{
        "the kernel refuses to lock this process' memory (", std::strerror(error), "): ",
        error == ENOMEM
            ? "raise RLIMIT_MEMLOCK (ulimit -l unlimited) or run with CAP_IPC_LOCK, and see that the box "
              "has that much memory"
            : "run as root or grant CAP_IPC_LOCK"});
}

void unlock_memory() noexcept {
    munlockall();
    locked.store(false, std::memory_order_release);
}

bool memory_is_locked() noexcept TAPPET_REALTIME { return locked.load(std::memory_order_acquire); }

// Not sysconf, because tests/stack could not determine the size of its stack.
std::size_t page_bytes() noexcept { return getauxval(AT_PAGESZ); }

void touch(std::span<std::byte> range) noexcept {
    const std::size_t page = page_bytes();
    volatile std::byte* bytes = range.data();
    for (std::size_t i = 0; i < range.size(); i += page) bytes[i] = bytes[i];
    if (!range.empty()) bytes[range.size() - 1] = bytes[range.size() - 1];
}

void touch_stack(std::size_t bytes) noexcept {
    if (bytes > 0) touch_below(bytes);
}

namespace {

/// Returns the bytes of the stack up to the end of its guard.
std::size_t end_of_guard(std::span<const std::byte> stack) noexcept {
    const std::size_t page = page_bytes();
    const std::size_t before = (page - reinterpret_cast<std::uintptr_t>(stack.data()) % page) % page;
    const std::size_t end = before + stack_guard_bytes(stack.size());
    return end <= stack.size() ? end : 0;
}

} // namespace

std::size_t stack_guard_bytes(std::size_t stack_bytes) noexcept {
    constexpr std::size_t wide = 16 * 1024;
    return stack_bytes < 4 * wide ? page_bytes() : std::max(wide, page_bytes());
}

std::span<std::byte> stack_guard(std::span<std::byte> stack) noexcept {
    const std::size_t end = end_of_guard(stack), bytes = stack_guard_bytes(stack.size());
    return end == 0 ? stack.first(0) : stack.subspan(end - bytes, bytes);
}

void paint_stack(std::span<std::byte> stack) noexcept {
    for (std::size_t i = 0; i + sizeof paint <= stack.size(); i += sizeof paint)
        std::memcpy(stack.data() + i, &paint, sizeof paint);
}

std::size_t stack_high_water_bytes(std::span<const std::byte> stack) noexcept {
    std::size_t unused = end_of_guard(stack);
    while (unused + sizeof paint <= stack.size() &&
           std::memcmp(stack.data() + unused, &paint, sizeof paint) == 0)
        unused += sizeof paint;
    return stack.size() - unused;
}

std::size_t rss_bytes() noexcept {
    const int file = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
    if (file < 0) return 0;
    char text[128] = {};
    const auto got = read(file, text, sizeof text - 1);
    close(file);
    if (got <= 0) return 0;
    char* rest = nullptr;
    std::strtoull(text, &rest, 10); // the first number is the size of all mappings
    return static_cast<std::size_t>(std::strtoull(rest, nullptr, 10)) * page_bytes();
}

} // namespace tappet::os
