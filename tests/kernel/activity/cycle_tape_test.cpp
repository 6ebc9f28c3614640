// The tape of an activity: recorded cycles are read back, the oldest is overwritten, and a reader in another
// thread never gets a torn cycle.
#include "kernel/activity/cycle_tape.hpp"

#include "kernel/base/random.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <thread>
#include <vector>

namespace tappet {
namespace {

struct Free {
    void operator()(CycleTape* tape) const {
        ::operator delete(tape, std::align_val_t{CycleTape::alignment});
    }
};
using Tape = std::unique_ptr<CycleTape, Free>;

Tape make_tape(std::size_t words) {
    void* memory = ::operator new(CycleTape::bytes_for(words), std::align_val_t{CycleTape::alignment});
    return Tape{new (memory) CycleTape{words}};
}

struct Mark {
    std::uint32_t function;
    std::int64_t end;
};

void record(CycleTape& tape, std::int64_t release, std::int64_t begin, const std::vector<Mark>& marks) {
    tape.begin();
    std::int64_t end = 0;
    for (const Mark& each : marks) tape.mark(each.function, end = each.end);
    tape.end(release, begin, begin + end);
}

TEST(CycleTape, returns_each_cycle_with_its_functions_newest_first) {
    const Tape tape = make_tape(256);
    record(*tape, 990, 1000, {{4, 10}, {0, 25}});
    record(*tape, 2000, 2000, {});
    record(*tape, 2995, 3000, {{1u << 19, 7}});
    TapeCycle cycle;
    ASSERT_TRUE(tape->cycle_before(tape->head(), cycle));
    EXPECT_EQ(cycle.response(), 12);
    EXPECT_EQ(cycle.busy(), 7);
    std::vector<std::uint64_t> marks(cycle.marks);
    ASSERT_TRUE(tape->copy(cycle.at, marks));
    EXPECT_EQ(TapeMark::of(marks.at(0)).function, 1u << 19);
    ASSERT_TRUE(tape->cycle_before(cycle.at, cycle));
    EXPECT_EQ(cycle.marks, 0u);
    EXPECT_EQ(cycle.end, 2000);
    ASSERT_TRUE(tape->cycle_before(cycle.at, cycle));
    EXPECT_EQ(cycle.release, 990);
    EXPECT_EQ(cycle.end, 1025);
    marks.resize(cycle.marks);
    ASSERT_TRUE(tape->copy(cycle.at, marks));
    ASSERT_EQ(marks.size(), 2u);
    EXPECT_EQ(TapeMark::of(marks[0]).function, 4u);
    EXPECT_EQ(TapeMark::of(marks[1]).end, 25);
    EXPECT_FALSE(tape->cycle_before(cycle.at, cycle)) << "before the first one there is none";
}

TEST(CycleTape, has_no_cycle_while_it_is_empty) {
    const Tape tape = make_tape(CycleTape::fewest_words);
    TapeCycle cycle;
    EXPECT_FALSE(tape->cycle_before(tape->head(), cycle));
    EXPECT_FALSE(tape->cycle_before(3, cycle)) << "nothing was written there";
    std::uint64_t word = 0;
    EXPECT_FALSE(tape->copy(0, {&word, 1}));
}

TEST(CycleTape, counts_functions_that_exceed_the_room_of_a_cycle) {
    const Tape tape = make_tape(64);
    const std::size_t room = tape->most_words() - TapeCycle::words_beside_marks;
    std::vector<Mark> marks;
    for (std::uint32_t i = 0; i < room + 300; ++i) marks.push_back({i, i});
    record(*tape, 0, 0, marks);
    TapeCycle cycle;
    ASSERT_TRUE(tape->cycle_before(tape->head(), cycle));
    EXPECT_EQ(cycle.marks, room);
    EXPECT_EQ(cycle.left_out, 255u);
    EXPECT_EQ(cycle.end, static_cast<std::int64_t>(marks.size()) - 1) << "its end is right all the same";
    record(*tape, 0, 0, {{1, 1}});
    ASSERT_TRUE(tape->cycle_before(tape->head(), cycle));
    EXPECT_EQ(cycle.left_out, 0u);
}

/// The expected content of a cycle with this number, to detect torn cycles.
std::uint32_t marks_of(std::uint64_t number) { return static_cast<std::uint32_t>(number * 7 % 8); }

void record_numbered(CycleTape& tape, std::uint64_t number) {
    const auto base = static_cast<std::int64_t>(number * 1000);
    tape.begin();
    const std::uint32_t marks = marks_of(number);
    for (std::uint32_t i = 0; i < marks; ++i)
        tape.mark(static_cast<std::uint32_t>((number + i) & 0xfffff),
                  static_cast<std::int64_t>(number % 900));
    tape.end(base - 1, base, base + static_cast<std::int64_t>(number % 900));
}

/// Reads back from the head and checks each cycle completely; returns their number.
std::size_t check_all(const CycleTape& tape) {
    std::size_t read = 0;
    TapeCycle cycle;
    std::uint64_t last = UINT64_MAX;
    for (std::uint64_t after = tape.head(); tape.cycle_before(after, cycle); after = cycle.at) {
        const auto number = static_cast<std::uint64_t>(cycle.begin / 1000);
        std::array<std::uint64_t, 16> words{};
        const std::span<std::uint64_t> marks{words.data(), cycle.marks};
        EXPECT_LE(cycle.marks, 8u);
        if (cycle.marks > 8 || !tape.copy(cycle.at, marks)) break;
        EXPECT_EQ(cycle.begin - cycle.release, 1);
        EXPECT_EQ(cycle.busy(), static_cast<std::int64_t>(number % 900));
        EXPECT_EQ(cycle.marks, marks_of(number));
        for (std::uint32_t i = 0; i < cycle.marks; ++i)
            EXPECT_EQ(TapeMark::of(marks[i]).function, (number + i) & 0xfffff);
        EXPECT_TRUE(last == UINT64_MAX || number + 1 == last) << "a cycle is left out before " << last;
        last = number;
        ++read;
    }
    return read;
}

TEST(CycleTape, keeps_the_last_cycles_whatever_their_lengths) {
    const Tape tape = make_tape(128);
    for (std::uint64_t number = 1; number < 500; ++number) {
        record_numbered(*tape, number);
        const std::size_t read = check_all(*tape);
        EXPECT_GE(read, std::min<std::size_t>(number, (128 - tape->most_words()) / 11 - 1));
    }
}

TEST(CycleTape, gives_whole_cycles_to_a_reader_during_writes) {
    const Tape tape = make_tape(256);
    std::atomic<bool> ends{false};
    std::atomic<std::uint64_t> written{0};
    std::thread writer{[&] {
        for (std::uint64_t number = 1; !ends.load(std::memory_order_relaxed); ++number) {
            record_numbered(*tape, number);
            written.store(number, std::memory_order_relaxed);
        }
    }};
    std::size_t read = 0;
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds{500};
    while (std::chrono::steady_clock::now() < end && !testing::Test::HasFailure()) read += check_all(*tape);
    ends = true;
    writer.join();
    EXPECT_GT(written.load(), 1000u);
    EXPECT_GT(read + check_all(*tape), 10u);
}

} // namespace
} // namespace tappet
