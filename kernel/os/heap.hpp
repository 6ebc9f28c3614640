// The heap of a firmware: one static arena until the machine arms, then sealed. Linking tappet_sealed_heap
// routes every malloc, operator new and mmap of the program to it, including glibc's internal ones.
#pragma once

#include "kernel/base/realtime.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tappet::os::heap {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool sanitizer_owns_malloc = true;
#elif defined(__has_feature)
inline constexpr bool sanitizer_owns_malloc =
    __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer) ||
    __has_feature(realtime_sanitizer) || __has_feature(leak_sanitizer);
#else
inline constexpr bool sanitizer_owns_malloc = false;
#endif

/// open: configuring. sealed: armed. An allocation breaks Contract::allocation_after_seal but is still
/// served, because the code that brings the machine to its safe state may be the one that allocates. A
/// mapping is refused, because memory that is not present yet cannot be served without page faults. released:
/// the machine is stopped; allocations are free again.
enum class State : std::uint8_t { open, sealed, released };

/// Seals the heap, and determines with owns_malloc() whether the seal counts. Not real-time.
void seal() noexcept;
/// Releases the heap, after the machine stopped. The counts stay.
void release() noexcept;
State state() noexcept TAPPET_REALTIME;

/// Returns whether this program's malloc uses the arena; false in builds with a sanitizer or without
/// tappet_sealed_heap, where nothing below can count. It allocates: not real-time, not while sealed.
bool owns_malloc() noexcept;
/// Returns the result of seal().
bool seal_counts() noexcept TAPPET_REALTIME;

std::uint64_t allocations_after_seal() noexcept TAPPET_REALTIME;
std::uint64_t mappings_after_seal() noexcept TAPPET_REALTIME; ///< all of them refused
std::uint64_t releases_after_seal() noexcept TAPPET_REALTIME; ///< calls of free: counted, no breach
std::uint64_t refused_allocations() noexcept TAPPET_REALTIME; ///< because there was no room

struct Use {
    std::size_t arena_bytes = 0;
    std::size_t used_bytes = 0; ///< headers included
    std::size_t high_water_bytes = 0;
    std::size_t free_bytes = 0;
    std::size_t largest_free_bytes = 0;
};
/// Walks the arena. Not real-time.
Use use() noexcept;
std::size_t used_bytes() noexcept;
std::size_t high_water_bytes() noexcept;

/// One of the first allocations after sealing, with its caller.
struct Record {
    std::size_t bytes = 0;
    std::uintptr_t caller = 0; ///< code address; addr2line names it
    int thread = 0;
    std::array<char, 16> thread_name{};
};
inline constexpr std::size_t max_records = 16;
std::span<const Record> records_after_seal() noexcept TAPPET_REALTIME;

/// The firmware's arena; see TAPPET_HEAP_ARENA.
struct Arena {
    std::byte* begin;
    std::size_t bytes;
};
extern const Arena firmware_arena;

// The entry points of malloc and its family.
void* allocate(const Arena& arena, std::size_t bytes, std::size_t align, std::uintptr_t caller) noexcept;
void* reallocate(const Arena& arena, void* piece, std::size_t bytes, std::uintptr_t caller) noexcept;
void deallocate(void* piece) noexcept;
std::size_t usable_bytes(void* piece) noexcept;
/// Returns whether memory may be mapped. After sealing: false, and a broken contract.
bool may_map(std::size_t bytes, std::uintptr_t caller) noexcept;

} // namespace tappet::os::heap

/// Use once, in one source of the firmware, at namespace scope. The C++ library alone needs 73 kB for
/// exceptions that it may throw when memory is short.
#define TAPPET_HEAP_ARENA(arena_bytes)                                                                       \
    namespace tappet::os::heap {                                                                             \
    static_assert((arena_bytes) >= 128 * 1024, "the C++ library takes 73 kB before main");                   \
    alignas(64) static constinit std::byte arena_memory[arena_bytes]{};                                      \
    constinit const Arena firmware_arena{arena_memory, arena_bytes};                                         \
    }
