// malloc with its whole family, and operator new, as this program's own. glibc then links none of its
// allocator, and allocations of the C and C++ libraries come here too. --wrap refuses address space, because
// glibc maps internally.
#include "kernel/base/contract.hpp"
#include "kernel/os/heap.hpp"
#include "kernel/os/heap_allocator.hpp"

#include <bit>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <new>

#include <unistd.h>

namespace {

namespace heap = tappet::os::heap;

#define TAPPET_CALLER reinterpret_cast<std::uintptr_t>(__builtin_return_address(0))

void* give(std::size_t bytes, std::size_t align, std::uintptr_t caller) noexcept {
    return heap::allocate(heap::firmware_arena, bytes, align, caller);
}

bool is_alignment(std::size_t align) noexcept { return std::has_single_bit(align); }

// A caller of malloc checks the result; a caller of operator new does not. Without exceptions on any path
// there is nobody to catch bad_alloc. So that thread stops, and with it, safely, the machine.
void* give_or_end(std::size_t bytes, std::size_t align, std::uintptr_t caller) noexcept {
    void* piece = give(bytes, align, caller);
    TAPPET_CONTRACT(piece != nullptr, tappet::Contract::memory_not_there, bytes, caller);
    return piece;
}

} // namespace

static_assert(!heap::sanitizer_owns_malloc,
              "a sanitizer's own malloc and this one cannot both be the program's");

extern "C" {

void* malloc(std::size_t bytes) noexcept { return give(bytes, heap::Allocator::alignment, TAPPET_CALLER); }

void free(void* piece) noexcept {
    const int kept = errno;
    heap::deallocate(piece);
    errno = kept;
}

void* calloc(std::size_t count, std::size_t bytes) noexcept {
    std::size_t all = 0;
    if (__builtin_mul_overflow(count, bytes, &all)) {
        errno = ENOMEM;
        return nullptr;
    }
    void* piece = give(all, heap::Allocator::alignment, TAPPET_CALLER);
    if (piece != nullptr) std::memset(piece, 0, all);
    return piece;
}

void* realloc(void* piece, std::size_t bytes) noexcept {
    if (piece != nullptr && bytes == 0) {
        free(piece);
        return nullptr;
    }
    return heap::reallocate(heap::firmware_arena, piece, bytes, TAPPET_CALLER);
}

void* reallocarray(void* piece, std::size_t count, std::size_t bytes) noexcept {
    std::size_t all = 0;
    if (__builtin_mul_overflow(count, bytes, &all)) {
        errno = ENOMEM;
        return nullptr;
    }
    return heap::reallocate(heap::firmware_arena, piece, all, TAPPET_CALLER);
}

void* memalign(std::size_t align, std::size_t bytes) noexcept {
    return give(bytes, std::bit_ceil(align), TAPPET_CALLER);
}

void* aligned_alloc(std::size_t align, std::size_t bytes) noexcept {
    if (is_alignment(align)) return give(bytes, align, TAPPET_CALLER);
    errno = EINVAL;
    return nullptr;
}

int posix_memalign(void** piece, std::size_t align, std::size_t bytes) noexcept {
    if (!is_alignment(align) || align % sizeof(void*) != 0) return EINVAL;
    const int kept = errno;
    void* given = give(bytes, align, TAPPET_CALLER);
    errno = kept;
    if (given == nullptr) return ENOMEM;
    *piece = given;
    return 0;
}

void* valloc(std::size_t bytes) noexcept {
    return give(bytes, static_cast<std::size_t>(sysconf(_SC_PAGESIZE)), TAPPET_CALLER);
}

void* pvalloc(std::size_t bytes) noexcept {
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    return give((bytes + page - 1) & ~(page - 1), page, TAPPET_CALLER);
}

std::size_t malloc_usable_size(void* piece) noexcept { return heap::usable_bytes(piece); }

} // extern "C"

void* operator new(std::size_t bytes) {
    return give_or_end(bytes, heap::Allocator::alignment, TAPPET_CALLER);
}
void* operator new[](std::size_t bytes) {
    return give_or_end(bytes, heap::Allocator::alignment, TAPPET_CALLER);
}
void* operator new(std::size_t bytes, std::align_val_t align) {
    return give_or_end(bytes, static_cast<std::size_t>(align), TAPPET_CALLER);
}
void* operator new[](std::size_t bytes, std::align_val_t align) {
    return give_or_end(bytes, static_cast<std::size_t>(align), TAPPET_CALLER);
}
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
    return give(bytes, heap::Allocator::alignment, TAPPET_CALLER);
}
void* operator new[](std::size_t bytes, const std::nothrow_t&) noexcept {
    return give(bytes, heap::Allocator::alignment, TAPPET_CALLER);
}
void* operator new(std::size_t bytes, std::align_val_t align, const std::nothrow_t&) noexcept {
    return give(bytes, static_cast<std::size_t>(align), TAPPET_CALLER);
}
void* operator new[](std::size_t bytes, std::align_val_t align, const std::nothrow_t&) noexcept {
    return give(bytes, static_cast<std::size_t>(align), TAPPET_CALLER);
}
void operator delete(void* piece) noexcept { free(piece); }
void operator delete[](void* piece) noexcept { free(piece); }
void operator delete(void* piece, std::size_t) noexcept { free(piece); }
void operator delete[](void* piece, std::size_t) noexcept { free(piece); }
void operator delete(void* piece, std::align_val_t) noexcept { free(piece); }
void operator delete[](void* piece, std::align_val_t) noexcept { free(piece); }
void operator delete(void* piece, std::size_t, std::align_val_t) noexcept { free(piece); }
void operator delete[](void* piece, std::size_t, std::align_val_t) noexcept { free(piece); }
