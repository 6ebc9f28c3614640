// The heap of a firmware: one static arena until the machine arms, then sealed. Linking tappet_sealed_heap
// puts every malloc, operator new and mmap of the program, glibc's own included, behind it.
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

/// open: configuring. sealed: armed; an allocation breaks Contract::allocation_after_seal and is still
/// served, because the code that brings the machine to its safe state may be the one that allocates; a
/// mapping is refused, because memory that is not there yet cannot be served without page faults. released:
/// the machine stands; free again.
enum class State : std::uint8_t { open, sealed, released };

/// Finds out, too, whether the seal counts: owns_malloc(). Not real-time.
void seal() noexcept;
/// After the machine stopped. What was counted stays.
void release() noexcept;
State state() noexcept TAPPET_REALTIME;

/// True when this program's malloc ends in the arena; false in builds with a sanitizer or without
/// tappet_sealed_heap, where nothing below can count. Tries it: not real-time, not while sealed.
bool owns_malloc() noexcept;
/// What seal() found.
bool seal_counts() noexcept TAPPET_REALTIME;

std::uint64_t allocations_after_seal() noexcept TAPPET_REALTIME;
std::uint64_t mappings_after_seal() noexcept TAPPET_REALTIME; ///< all of them refused
std::uint64_t releases_after_seal() noexcept TAPPET_REALTIME; ///< calls of free: counted, no breach
std::uint64_t refused_allocations() noexcept TAPPET_REALTIME; ///< for want of room

struct Use {
    std::size_t arena_bytes = 0;
    std::size_t used_bytes = 0; ///< headers included
    std::size_t high_water_bytes = 0;
    std::size_t free_bytes = 0;
    std::size_t largest_free_bytes = 0;
};
/// Walks the arena: not real-time.
Use use() noexcept;
std::size_t used_bytes() noexcept;
std::size_t high_water_bytes() noexcept;

/// The first allocations after sealing: who did it.
struct Record {
    std::size_t bytes = 0;
    std::uintptr_t caller = 0; ///< code address; addr2line names it
    int thread = 0;
    std::array<char, 16> thread_name{};
};
inline constexpr std::size_t max_records = 16;
std::span<const Record> records_after_seal() noexcept TAPPET_REALTIME;

/// What the firmware gives; see TAPPET_HEAP_ARENA.
struct Arena {
    std::byte* begin;
    std::size_t bytes;
};
extern const Arena firmware_arena;

// Where malloc and its family come in.
void* allocate(const Arena& arena, std::size_t bytes, std::size_t align, std::uintptr_t caller) noexcept;
void* reallocate(const Arena& arena, void* piece, std::size_t bytes, std::uintptr_t caller) noexcept;
void deallocate(void* piece) noexcept;
std::size_t usable_bytes(void* piece) noexcept;
/// False, and a broken contract, after sealing.
bool may_map(std::size_t bytes, std::uintptr_t caller) noexcept;

} // namespace tappet::os::heap

/// Once, in one source of the firmware, at namespace scope. The C++ library alone takes 73 kB for exceptions
/// it may have to throw when memory is short.
#define TAPPET_HEAP_ARENA(arena_bytes)                                                                       \
    namespace tappet::os::heap {                                                                             \
    static_assert((arena_bytes) >= 128 * 1024, "the C++ library takes 73 kB before main");                   \
    alignas(64) static constinit std::byte arena_memory[arena_bytes]{};                                      \
    constinit const Arena firmware_arena{arena_memory, arena_bytes};                                         \
    }
