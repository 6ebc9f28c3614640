// The allocator of the arena: two-level segregated fit (Masmano, Ripoll, Crespo, Real: TLSF, ECRTS 2004).
// Each operation has a bounded number of steps; freed neighbours merge at once. One thread; the caller locks.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tappet::os::heap {

/// Constant-initialised, so that it works before any constructor has run.
class Allocator {
public:
    static constexpr std::size_t alignment = 16; ///< of every block: max_align_t of x86-64 and arm64
    static constexpr std::size_t header_bytes = 16;
    static constexpr std::size_t arena_bytes_min = 256;
    static constexpr std::size_t arena_bytes_max = std::size_t{1} << 31;

    constexpr Allocator() = default;
    Allocator(const Allocator&) = delete;
    Allocator& operator=(const Allocator&) = delete;

    /// Takes over the arena, which outlives the allocator; once.
    void open(std::span<std::byte> arena) noexcept;
    [[nodiscard]] bool is_open() const noexcept { return begin_ != nullptr; }

    /// Allocates a piece. Returns nullptr when no free piece is large enough. `align` is a power of two. For
    /// zero bytes it still allocates a piece.
    [[nodiscard]] void* allocate(std::size_t bytes, std::size_t align = alignment) noexcept;
    /// Frees a piece, which came from allocate and is in use.
    void release(void* piece) noexcept;
    /// Resizes a piece, in place if possible. When there is no room: nullptr, and `piece` is unchanged.
    [[nodiscard]] void* resize(void* piece, std::size_t bytes) noexcept;

    [[nodiscard]] bool contains(const void* piece) const noexcept;
    /// The state of a piece for release. The caller breaks a contract on any state but `in_use`.
    enum class Piece : std::uint8_t { in_use, free, foreign, damaged };
    [[nodiscard]] Piece look_at(const void* piece) const noexcept;
    [[nodiscard]] std::size_t usable_bytes(const void* piece) const noexcept;

    [[nodiscard]] std::size_t capacity_bytes() const noexcept; ///< the largest piece an empty arena can give
    [[nodiscard]] std::size_t used_bytes() const noexcept { return used_; } ///< headers included
    [[nodiscard]] std::size_t high_water_bytes() const noexcept { return high_water_; }
    [[nodiscard]] std::size_t free_bytes() const noexcept;         ///< walks the arena
    [[nodiscard]] std::size_t largest_free_bytes() const noexcept; ///< walks the arena
    /// Returns whether the chain of blocks, the free lists and the accounts agree, and no two free blocks are
    /// neighbours. Walks everything.
    [[nodiscard]] bool is_sound() const noexcept;

private:
    struct Block;
    static constexpr unsigned second_bits = 4, second_count = 1u << second_bits;
    static constexpr std::size_t small_bytes = alignment * second_count; // below it, classes are linear
    static constexpr unsigned first_count = 25;
    static_assert((small_bytes << (first_count - 2)) >= arena_bytes_max, "every arena size has a class");
    struct Class {
        unsigned first, second;
    };

    static Class class_of(std::size_t bytes) noexcept;
    static Class class_above(std::size_t bytes) noexcept;
    Block* find_free(std::size_t bytes) const noexcept;
    void insert(Block* block) noexcept;
    void remove(Block* block) noexcept;
    void cut(Block* block, std::size_t bytes) noexcept;
    void take(Block* block) noexcept;
    void merge_next(Block* block) noexcept;

    Block* begin_ = nullptr;
    Block* end_ = nullptr; // a header without a payload, always in use
    std::size_t used_ = 0;
    std::size_t high_water_ = 0;
    std::uint32_t firsts_ = 0; // one bit for each first level that has a free block
    std::array<std::uint32_t, first_count> seconds_{};
    std::array<std::array<Block*, second_count>, first_count> lists_{};
};

} // namespace tappet::os::heap
