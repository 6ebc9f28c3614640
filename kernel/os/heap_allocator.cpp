// Blocks are contiguous. Each has a header with its size and its lower neighbour; free ones are in the list
// of their class. A search starts one class up, so that any block in it fits.
#include "kernel/os/heap_allocator.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace tappet::os::heap {

struct Allocator::Block {
    Block* below;           // the neighbour at the lower address; nullptr for the first
    std::size_t size_state; // payload bytes, a multiple of the alignment; bit 0: free
    // In the payload while the block is free:
    Block* next;
    Block* before;

    [[nodiscard]] std::size_t size() const noexcept { return size_state & ~std::size_t{1}; }
    [[nodiscard]] bool is_free() const noexcept { return (size_state & 1) != 0; }
    [[nodiscard]] std::byte* payload() noexcept { return reinterpret_cast<std::byte*>(this) + header_bytes; }
    [[nodiscard]] Block* above() noexcept { return at(payload() + size()); }
    static Block* at(void* address) noexcept { return static_cast<Block*>(address); }
    static Block* of(void* piece) noexcept { return at(static_cast<std::byte*>(piece) - header_bytes); }
};

namespace {
// A payload holds the two list pointers while it is free.
constexpr std::size_t payload_min = 2 * sizeof(void*);
static_assert(payload_min % Allocator::alignment == 0, "the smallest payload keeps its neighbour aligned");

constexpr std::size_t rounded(std::size_t bytes, std::size_t to) noexcept {
    return (bytes + to - 1) & ~(to - 1);
}
} // namespace

void Allocator::open(std::span<std::byte> arena) noexcept {
    static_assert(offsetof(Block, next) == header_bytes, "the header is what lies before the payload");
    const auto start = reinterpret_cast<std::uintptr_t>(arena.data());
    const std::size_t skipped = rounded(start, alignment) - start;
    if (arena.size() < arena_bytes_min || arena.size() > arena_bytes_max) return;
    const std::size_t bytes = (arena.size() - skipped) & ~(alignment - 1);
    begin_ = Block::at(arena.data() + skipped);
    begin_->below = nullptr;
    begin_->size_state = bytes - 2 * header_bytes;
    end_ = begin_->above();
    end_->below = begin_;
    end_->size_state = 0;
    insert(begin_);
}

Allocator::Class Allocator::class_of(std::size_t bytes) noexcept {
    if (bytes < small_bytes) return {0, static_cast<unsigned>(bytes / alignment)};
    const auto log = static_cast<unsigned>(std::bit_width(bytes)) - 1;
    constexpr auto small_log = static_cast<unsigned>(std::bit_width(small_bytes)) - 1;
    return {log - small_log + 1, static_cast<unsigned>(bytes >> (log - second_bits)) - second_count};
}

Allocator::Class Allocator::class_above(std::size_t bytes) noexcept {
    if (bytes < small_bytes) return class_of(bytes);
    const auto log = static_cast<unsigned>(std::bit_width(bytes)) - 1;
    return class_of(bytes + (std::size_t{1} << (log - second_bits)) - 1);
}

Allocator::Block* Allocator::find_free(std::size_t bytes) const noexcept {
    auto [first, second] = class_above(bytes);
    if (first < first_count) {
        std::uint32_t seconds = seconds_[first] & (~std::uint32_t{0} << second);
        if (seconds == 0) {
            const std::uint32_t firsts =
                firsts_ & static_cast<std::uint32_t>(~std::uint64_t{0} << (first + 1));
            if (firsts != 0) {
                first = static_cast<unsigned>(std::countr_zero(firsts));
                seconds = seconds_[first];
            }
        }
        if (seconds != 0) return lists_[first][static_cast<unsigned>(std::countr_zero(seconds))];
    }
    // The class of the size itself holds blocks that fit and blocks that do not: only its first is checked.
    const Class own = class_of(bytes);
    Block* block = own.first < first_count ? lists_[own.first][own.second] : nullptr;
    return block != nullptr && block->size() >= bytes ? block : nullptr;
}

void Allocator::insert(Block* block) noexcept {
    const auto [first, second] = class_of(block->size());
    Block*& head = lists_[first][second];
    block->size_state |= 1;
    block->next = head;
    block->before = nullptr;
    if (head != nullptr) head->before = block;
    head = block;
    seconds_[first] |= 1u << second;
    firsts_ |= 1u << first;
}

void Allocator::remove(Block* block) noexcept {
    const auto [first, second] = class_of(block->size());
    if (block->next != nullptr) block->next->before = block->before;
    if (block->before != nullptr)
        block->before->next = block->next;
    else
        lists_[first][second] = block->next;
    if (lists_[first][second] == nullptr) {
        seconds_[first] &= ~(1u << second);
        if (seconds_[first] == 0) firsts_ &= ~(1u << first);
    }
    block->size_state &= ~std::size_t{1};
}

// Frees the part of a used block beyond `bytes`.
void Allocator::cut(Block* block, std::size_t bytes) noexcept {
    if (block->size() - bytes < header_bytes + payload_min) return;
    Block* rest = Block::at(block->payload() + bytes);
    rest->below = block;
    rest->size_state = block->size() - bytes - header_bytes;
    block->size_state = bytes;
    rest->above()->below = rest;
    merge_next(rest);
    insert(rest);
}

void Allocator::merge_next(Block* block) noexcept {
    Block* next = block->above();
    if (!next->is_free()) return;
    remove(next);
    block->size_state += header_bytes + next->size();
    block->above()->below = block;
}

void Allocator::take(Block* block) noexcept {
    used_ += header_bytes + block->size();
    high_water_ = std::max(high_water_, used_);
}

void* Allocator::allocate(std::size_t bytes, std::size_t align) noexcept {
    if (!is_open() || bytes > arena_bytes_max || align > arena_bytes_max) return nullptr;
    const std::size_t wanted = std::max(rounded(bytes, alignment), payload_min);
    // The part before an aligned piece becomes a block of its own, so it needs room for one.
    const std::size_t room = align > alignment ? align + header_bytes + payload_min : 0;
    Block* block = find_free(wanted + room);
    if (block == nullptr) return nullptr;
    remove(block);
    if (room != 0) {
        const auto start = reinterpret_cast<std::uintptr_t>(block->payload());
        std::size_t gap = rounded(start, align) - start;
        if (gap != 0 && gap < header_bytes + payload_min) gap += align;
        if (gap != 0) {
            Block* piece = Block::at(block->payload() + gap - header_bytes);
            piece->below = block;
            piece->size_state = block->size() - gap;
            block->size_state = gap - header_bytes;
            piece->above()->below = piece;
            insert(block); // its lower neighbour is in use: two free blocks never touch
            block = piece;
        }
    }
    cut(block, wanted);
    take(block);
    return block->payload();
}

void Allocator::release(void* piece) noexcept {
    Block* block = Block::of(piece);
    used_ -= header_bytes + block->size();
    merge_next(block);
    if (Block* below = block->below; below != nullptr && below->is_free()) {
        remove(below);
        below->size_state += header_bytes + block->size();
        below->above()->below = below;
        block = below;
    }
    insert(block);
}

void* Allocator::resize(void* piece, std::size_t bytes) noexcept {
    if (bytes > arena_bytes_max) return nullptr;
    Block* block = Block::of(piece);
    const std::size_t before = block->size();
    const std::size_t wanted = std::max(rounded(bytes, alignment), payload_min);
    Block* next = block->above();
    const std::size_t reach = before + (next->is_free() ? header_bytes + next->size() : 0);
    if (wanted <= reach) {
        used_ -= header_bytes + before;
        if (wanted > before) merge_next(block);
        cut(block, wanted);
        take(block);
        return piece;
    }
    void* moved = allocate(bytes);
    if (moved == nullptr) return nullptr;
    std::memcpy(moved, piece, std::min(before, bytes));
    release(piece);
    return moved;
}

bool Allocator::contains(const void* piece) const noexcept {
    const auto address = reinterpret_cast<std::uintptr_t>(piece);
    return is_open() && address > reinterpret_cast<std::uintptr_t>(begin_) &&
           address < reinterpret_cast<std::uintptr_t>(end_);
}

Allocator::Piece Allocator::look_at(const void* piece) const noexcept {
    if (!contains(piece) || reinterpret_cast<std::uintptr_t>(piece) % alignment != 0) return Piece::foreign;
    Block* block = Block::of(const_cast<void*>(piece));
    if (block < begin_) return Piece::foreign;
    const auto left = static_cast<std::size_t>(reinterpret_cast<std::byte*>(end_) - block->payload());
    if (block->size() % alignment != 0 || block->size() > left) return Piece::damaged;
    if (block->above()->below != block) return Piece::damaged;
    // The pointer may be anything: it is followed only where a block can be.
    if (const Block* below = block->below; below != nullptr) {
        const auto at = reinterpret_cast<std::uintptr_t>(below),
                   here = reinterpret_cast<std::uintptr_t>(block);
        if (at % alignment != 0 || at < reinterpret_cast<std::uintptr_t>(begin_) || at >= here)
            return Piece::damaged;
        if (below->size() != here - at - header_bytes) return Piece::damaged;
    }
    return block->is_free() ? Piece::free : Piece::in_use;
}

std::size_t Allocator::usable_bytes(const void* piece) const noexcept {
    return Block::of(const_cast<void*>(piece))->size();
}

std::size_t Allocator::capacity_bytes() const noexcept {
    return is_open() ? static_cast<std::size_t>(reinterpret_cast<std::byte*>(end_) - begin_->payload()) : 0;
}

std::size_t Allocator::free_bytes() const noexcept {
    std::size_t sum = 0;
    for (Block* block = begin_; block != end_; block = block->above())
        sum += block->is_free() ? block->size() : 0;
    return sum;
}

std::size_t Allocator::largest_free_bytes() const noexcept {
    std::size_t most = 0;
    for (Block* block = begin_; block != end_; block = block->above())
        if (block->is_free()) most = std::max(most, block->size());
    return most;
}

bool Allocator::is_sound() const noexcept {
    std::size_t used = 0, free_blocks = 0, listed = 0;
    bool free_below = false;
    Block* below = nullptr;
    for (Block* block = begin_; block != end_; below = block, block = block->above()) {
        if (block > end_ || block->below != below || block->size() < payload_min) return false;
        if (block->is_free() && free_below) return false;
        free_below = block->is_free();
        if (free_below)
            ++free_blocks;
        else
            used += header_bytes + block->size();
    }
    if (is_open() && end_->below != below) return false;
    for (unsigned first = 0; first < first_count; ++first) {
        if (((firsts_ >> first & 1u) != 0) != (seconds_[first] != 0)) return false;
        for (unsigned second = 0; second < second_count; ++second) {
            const Block* head = lists_[first][second];
            if (((seconds_[first] >> second & 1u) != 0) != (head != nullptr)) return false;
            for (const Block* block = head; block != nullptr; block = block->next, ++listed) {
                const Class own = class_of(block->size());
                if (!block->is_free() || own.first != first || own.second != second) return false;
                if (block->next != nullptr && block->next->before != block) return false;
            }
        }
    }
    return used == used_ && listed == free_blocks;
}

} // namespace tappet::os::heap
