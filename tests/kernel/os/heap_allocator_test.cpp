// The arena's allocator: for any sequence of calls, blocks are aligned, separate, tracked and merged again.
#include "kernel/os/heap_allocator.hpp"

#include "kernel/base/random.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include <vector>

namespace tappet::os::heap {
namespace {

struct Piece {
    std::byte* at;
    std::size_t bytes;
    std::size_t align;
    std::byte mark;
};

class Arena {
public:
    explicit Arena(std::size_t bytes, std::size_t offset = 0) : memory_(bytes + offset) {
        allocator.open(std::span{memory_}.subspan(offset));
    }
    Allocator allocator;

private:
    std::vector<std::byte> memory_;
};

bool holds_its_mark(const Piece& piece, std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; ++i)
        if (piece.at[i] != piece.mark) return false;
    return true;
}

bool is_aligned(const void* at, std::size_t align) {
    return reinterpret_cast<std::uintptr_t>(at) % align == 0;
}

std::size_t drawn_size(Random& random) {
    const auto scale = random.below(14);
    return random.below(std::uint64_t{1} << scale);
}

class AllocatorSequence : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(AllocatorSequence, keeps_blocks_aligned_separate_and_unchanged) {
    Random random{GetParam()};
    const std::size_t arena_bytes = 40'000 + random.below(60'000);
    const std::size_t offset = random.below(64);
    Arena arena{arena_bytes, offset};
    Allocator& heap = arena.allocator;
    const std::size_t whole = heap.free_bytes();
    std::vector<Piece> pieces;
    std::size_t refused = 0;
    for (int step = 0; step < 6000; ++step) {
        const auto choice = random.below(10);
        if (choice < 5) {
            const std::size_t bytes = drawn_size(random);
            const std::size_t align =
                random.one_in(4) ? std::size_t{1} << random.below(13) : Allocator::alignment;
            auto* at = static_cast<std::byte*>(heap.allocate(bytes, align));
            if (at == nullptr) {
                ++refused;
                continue;
            }
            ASSERT_TRUE(is_aligned(at, align) && is_aligned(at, Allocator::alignment)) << align;
            ASSERT_GE(heap.usable_bytes(at), bytes);
            for (const Piece& other : pieces)
                ASSERT_TRUE(at + bytes <= other.at || other.at + other.bytes <= at) << "two pieces overlap";
            pieces.push_back({at, bytes, align, static_cast<std::byte>(random.below(256))});
            std::memset(at, static_cast<int>(pieces.back().mark), bytes);
        } else if (!pieces.empty()) {
            const auto chosen = random.below(pieces.size());
            Piece& piece = pieces[chosen];
            ASSERT_TRUE(holds_its_mark(piece, piece.bytes));
            if (choice < 8) {
                ASSERT_EQ(heap.look_at(piece.at), Allocator::Piece::in_use);
                heap.release(piece.at);
                pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(chosen));
            } else {
                const std::size_t bytes = drawn_size(random);
                auto* moved = static_cast<std::byte*>(heap.resize(piece.at, bytes));
                if (moved == nullptr) {
                    ++refused;
                    ASSERT_TRUE(holds_its_mark(piece, piece.bytes))
                        << "a refused resize leaves the piece as it was";
                    continue;
                }
                piece.at = moved;
                ASSERT_TRUE(holds_its_mark(piece, std::min(bytes, piece.bytes)));
                piece.bytes = bytes;
                std::memset(moved, static_cast<int>(piece.mark), bytes);
            }
        }
        if (step % 16 == 0) {
            ASSERT_TRUE(heap.is_sound()) << "after step " << step;
        }
    }
    EXPECT_GT(refused, 0u) << "the sequence is meant to reach exhaustion";
    for (const Piece& piece : pieces) {
        ASSERT_TRUE(holds_its_mark(piece, piece.bytes));
        heap.release(piece.at);
    }
    EXPECT_TRUE(heap.is_sound());
    EXPECT_EQ(heap.used_bytes(), 0u);
    EXPECT_EQ(heap.free_bytes(), whole);
    EXPECT_EQ(heap.largest_free_bytes(), whole) << "everything merged into one piece again";
    EXPECT_GT(heap.high_water_bytes(), arena_bytes / 2);
    EXPECT_LE(heap.high_water_bytes(), arena_bytes);
}

INSTANTIATE_TEST_SUITE_P(Seeds, AllocatorSequence, ::testing::Range(std::uint64_t{1}, std::uint64_t{25}));

TEST(Allocator, allocates_the_whole_arena_in_one_block) {
    Arena arena{4096};
    const std::size_t all = arena.allocator.capacity_bytes();
    EXPECT_GE(all, 4096 - 3 * Allocator::header_bytes);
    void* piece = arena.allocator.allocate(all);
    ASSERT_NE(piece, nullptr);
    EXPECT_EQ(arena.allocator.free_bytes(), 0u);
    EXPECT_EQ(arena.allocator.allocate(1), nullptr);
    arena.allocator.release(piece);
    EXPECT_EQ(arena.allocator.largest_free_bytes(), all);
}

TEST(Allocator, refuses_more_than_is_available) {
    Arena arena{4096};
    EXPECT_EQ(arena.allocator.allocate(arena.allocator.capacity_bytes() + 1), nullptr);
    EXPECT_EQ(arena.allocator.allocate(~std::size_t{0}), nullptr);
    EXPECT_EQ(arena.allocator.allocate(~std::size_t{0} - 8), nullptr);
    EXPECT_EQ(arena.allocator.allocate(16, std::size_t{1} << 40), nullptr);
    EXPECT_EQ(arena.allocator.allocate(16, 8192), nullptr);
    EXPECT_TRUE(arena.allocator.is_sound());
    EXPECT_EQ(arena.allocator.used_bytes(), 0u);
}

TEST(Allocator, allocates_a_separate_block_for_zero_bytes) {
    Arena arena{4096};
    void* one = arena.allocator.allocate(0);
    void* two = arena.allocator.allocate(0);
    EXPECT_NE(one, nullptr);
    EXPECT_NE(one, two);
}

TEST(Allocator, refuses_an_arena_too_small_to_manage) {
    Arena small{Allocator::arena_bytes_min - 1};
    EXPECT_FALSE(small.allocator.is_open());
    EXPECT_EQ(small.allocator.allocate(1), nullptr);
}

TEST(Allocator, grows_in_place_into_a_free_neighbour) {
    Arena arena{8192};
    void* first = arena.allocator.allocate(100);
    void* second = arena.allocator.allocate(1000);
    void* wall = arena.allocator.allocate(100);
    ASSERT_NE(wall, nullptr);
    arena.allocator.release(second);
    EXPECT_EQ(arena.allocator.resize(first, 1000), first);
    EXPECT_NE(arena.allocator.resize(first, 2000), first);
    EXPECT_TRUE(arena.allocator.is_sound());
}

TEST(Allocator, distinguishes_allocated_blocks_from_other_pointers) {
    Arena arena{8192};
    auto* piece = static_cast<std::byte*>(arena.allocator.allocate(64));
    auto* wall = static_cast<std::byte*>(arena.allocator.allocate(64));
    int elsewhere = 0;
    EXPECT_EQ(arena.allocator.look_at(piece), Allocator::Piece::in_use);
    EXPECT_EQ(arena.allocator.look_at(&elsewhere), Allocator::Piece::foreign);
    EXPECT_EQ(arena.allocator.look_at(piece + 1), Allocator::Piece::foreign);
    std::memset(piece, 0x5a, 64 + 8); // past the end, into the header of the next
    EXPECT_EQ(arena.allocator.look_at(wall), Allocator::Piece::damaged);
    EXPECT_EQ(arena.allocator.look_at(piece), Allocator::Piece::damaged);
    EXPECT_FALSE(arena.allocator.is_sound());
}

TEST(Allocator, recognises_a_block_that_was_already_freed) {
    Arena arena{8192};
    void* piece = arena.allocator.allocate(64);
    void* wall = arena.allocator.allocate(64);
    ASSERT_NE(wall, nullptr);
    arena.allocator.release(piece);
    EXPECT_EQ(arena.allocator.look_at(piece), Allocator::Piece::free);
}

} // namespace
} // namespace tappet::os::heap
