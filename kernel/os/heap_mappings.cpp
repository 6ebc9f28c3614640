// Address space after sealing: every way to get some, including glibc's internal ones, is checked here first.
// Linked with --wrap for each name below, into static programs only: a shared C library's own calls cannot be
// wrapped.
#include "kernel/os/heap.hpp"

#include <cerrno>
#include <cstdarg>
#include <cstddef>
#include <cstdint>

#include <sys/mman.h>
#include <sys/types.h>

// Reserved names, as --wrap requires them.
// NOLINTBEGIN(bugprone-reserved-identifier)

#define TAPPET_MAY_MAP(bytes)                                                                                \
    ::tappet::os::heap::may_map((bytes), reinterpret_cast<std::uintptr_t>(__builtin_return_address(0)))

#define TAPPET_WRAP_MMAP(name)                                                                               \
    extern "C" void* __real_##name(void*, std::size_t, int, int, int, off_t) noexcept;                       \
    extern "C" void* __wrap_##name(void* at, std::size_t bytes, int protection, int flags, int file,         \
                                   off_t offset) noexcept;                                                   \
    void* __wrap_##name(void* at, std::size_t bytes, int protection, int flags, int file,                    \
                        off_t offset) noexcept {                                                             \
        if (TAPPET_MAY_MAP(bytes)) return __real_##name(at, bytes, protection, flags, file, offset);         \
        errno = ENOMEM;                                                                                      \
        return MAP_FAILED;                                                                                   \
    }

TAPPET_WRAP_MMAP(mmap)
TAPPET_WRAP_MMAP(mmap64)
TAPPET_WRAP_MMAP(__mmap)
TAPPET_WRAP_MMAP(__mmap64)

extern "C" {
void* __real_mremap(void*, std::size_t, std::size_t, int, void*) noexcept;
void* __wrap_mremap(void* at, std::size_t before, std::size_t bytes, int flags, ...) noexcept;
int __real_brk(void*) noexcept;
int __wrap_brk(void* end) noexcept;
void* __real_sbrk(std::intptr_t) noexcept;
void* __wrap_sbrk(std::intptr_t bytes) noexcept;
void* __real___sbrk(std::intptr_t) noexcept;
void* __wrap___sbrk(std::intptr_t bytes) noexcept;
}

void* __wrap_mremap(void* at, std::size_t before, std::size_t bytes, int flags, ...) noexcept {
    void* to = nullptr;
    if ((flags & MREMAP_FIXED) != 0) {
        va_list rest;
        va_start(rest, flags);
        to = va_arg(rest, void*);
        va_end(rest);
    }
    // Shrinking or moving in place needs no new memory.
    if (bytes <= before || TAPPET_MAY_MAP(bytes - before)) return __real_mremap(at, before, bytes, flags, to);
    errno = ENOMEM;
    return MAP_FAILED;
}

int __wrap_brk(void* end) noexcept {
    if (TAPPET_MAY_MAP(0)) return __real_brk(end);
    errno = ENOMEM;
    return -1;
}

void* __wrap_sbrk(std::intptr_t bytes) noexcept {
    if (bytes <= 0 || TAPPET_MAY_MAP(static_cast<std::size_t>(bytes))) return __real_sbrk(bytes);
    errno = ENOMEM;
    return MAP_FAILED;
}

void* __wrap___sbrk(std::intptr_t bytes) noexcept {
    if (bytes <= 0 || TAPPET_MAY_MAP(static_cast<std::size_t>(bytes))) return __real___sbrk(bytes);
    errno = ENOMEM;
    return MAP_FAILED;
}

// NOLINTEND(bugprone-reserved-identifier)
