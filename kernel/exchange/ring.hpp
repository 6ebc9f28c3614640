// A queue from one thread to one other, in storage that the machine's planner provides: wait-free on both
// sides and in order. When full, it either refuses the newest value or drops the oldest (thesis 4.4: the
// buffer).
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/exchange/words.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <new>

namespace tappet {

/// The policy of a full ring for one more value.
enum class Overflow : std::uint8_t {
    reject,      ///< push returns false, the ring is as it was
    drop_oldest, ///< push always succeeds, the oldest is lost
};

/// A ring of any capacity from 1. Each index is next to its owner's private state and far from what the other
/// side polls. The other side's index is loaded only when the local copy of it no longer suffices.
template <Exchangeable T, template <class> class Atomic = std::atomic> class Ring {
    using Value = Words<T, Atomic>;
    struct CellLayout {
        Atomic<std::uint64_t> number;
        Value value;
    };
    // Cells smaller than a cache line share one without crossing two; larger cells begin on their own line.
    struct alignas(std::min<std::size_t>(64, std::bit_ceil(sizeof(CellLayout)))) Cell {
        Atomic<std::uint64_t> number{}; // of the value in it, from 1; 0: none, or being written
        Value value{};
    };

    // When the ring drops values, the producer writes this far behind the oldest value that the consumer may
    // still take. So an attempt to take it fails only if the producer pushes this often within that one copy.
    static constexpr std::size_t spare_cells = 2;
    static constexpr std::size_t attempts = 3;
    static_assert(spare_cells >= 1, "with none the producer writes into the very value being taken");
    static_assert(attempts >= 2,
                  "an attempt that was overtaken skips what was lost; the next one may then succeed");

public:
    static constexpr std::size_t alignment = alignof(Cell);
    [[nodiscard]] static constexpr std::size_t bytes_for(std::size_t capacity) noexcept {
        return (capacity + spare_cells) * sizeof(Cell);
    }

    /// An empty ring that refuses everything until it is placed.
    constexpr Ring() = default;
    /// `storage`: bytes_for(capacity) bytes at `alignment`; must outlive the ring.
    Ring(std::byte* storage, std::size_t capacity, Overflow overflow) noexcept {
        place(storage, capacity, overflow);
    }
    Ring(const Ring&) = delete;
    Ring& operator=(const Ring&) = delete;

    /// As the constructor; before either side uses the ring.
    void place(std::byte* storage, std::size_t capacity, Overflow overflow) noexcept {
        const std::size_t cells = capacity + (overflow == Overflow::drop_oldest ? spare_cells : 0);
        Cell* first = nullptr;
        for (std::size_t i = 0; i < cells; ++i) {
            Cell* cell = ::new (static_cast<void*>(storage + i * sizeof(Cell))) Cell{};
            if (i == 0) first = cell;
        }
        producer_.place = {first, cells, capacity, overflow};
        consumer_.place = producer_.place;
    }

    /// Adds a value; one copy. Producer only. Returns false when the ring is full and refuses it.
    [[nodiscard]] bool push(const T& value) noexcept TAPPET_REALTIME {
        Producer& my = producer_;
        if (my.place.overflow == Overflow::reject && my.position - my.consumed == my.place.capacity) {
            my.consumed = head_.load(std::memory_order_acquire); // ring.push_look
            if (my.position - my.consumed == my.place.capacity) {
                const std::uint64_t refused = my.refused.load(std::memory_order_relaxed); // ring.push_refuse
                my.refused.store(refused + 1, std::memory_order_relaxed);                 // ring.push_refuse
                return false;
            }
        }
        Cell& cell = my.place.cells[my.cell];
        cell.number.store(0, std::memory_order_relaxed); // ring.push_mark
        cell.value.store(value);
        cell.number.store(my.position + 1, std::memory_order_release); // ring.push_number
        ++my.position;
        my.cell = my.cell + 1 == my.place.count ? 0 : my.cell + 1;
        raise_mark();
        tail_.store(my.position, std::memory_order_release); // ring.push_publish
        return true;
    }

    /// Takes the oldest value, in at most `attempts` copies; without overflow exactly one. Consumer only.
    /// Returns false, with `into` unchanged, when the ring is empty; or, if it drops values, when the
    /// producer overtook every attempt. Then the next call continues after the lost values.
    [[nodiscard]] bool pop(T& into) noexcept TAPPET_REALTIME {
        return consumer_.place.overflow == Overflow::reject ? pop_next(into) : pop_oldest_left(into);
    }

    /// As pop(), for a ring that rejects: nothing was ever lost, so one attempt suffices.
    [[nodiscard]] bool pop_next(T& into) noexcept TAPPET_REALTIME {
        Consumer& my = consumer_;
        if (my.position == my.produced) {
            my.produced = tail_.load(std::memory_order_acquire); // ring.pop_look
            if (my.position == my.produced) return false;
        }
        my.place.cells[my.cell].value.load(into);
        advance();
        return true;
    }

    /// Returns the number of values inside. For either side it is exact as far as that side's own actions go;
    /// any other thread sees a recent number.
    [[nodiscard]] std::size_t size() const noexcept TAPPET_REALTIME {
        const std::uint64_t head = head_.load(std::memory_order_acquire); // ring.size_head
        const std::uint64_t tail = tail_.load(std::memory_order_acquire); // ring.size_tail
        return static_cast<std::size_t>(std::min<std::uint64_t>(tail - head, consumer_.place.capacity));
    }
    [[nodiscard]] bool empty() const noexcept TAPPET_REALTIME { return size() == 0; }
    [[nodiscard]] std::size_t capacity() const noexcept TAPPET_REALTIME { return consumer_.place.capacity; }
    /// Returns the largest number of values ever inside; the rest of capacity() was never needed. Any thread.
    [[nodiscard]] std::size_t high_water() const noexcept TAPPET_REALTIME {
        const std::uint64_t mark = producer_.high_water.load(std::memory_order_relaxed); // ring.mark_read
        return static_cast<std::size_t>(mark);
    }
    /// Returns the number of pushed values that will never be popped, by either policy. Either side; exact
    /// while the other side is at rest, otherwise it may differ by the other side's action in progress.
    /// Nothing counts twice, but for a value being taken it is open whether the producer comes first.
    [[nodiscard]] std::uint64_t lost() const noexcept TAPPET_REALTIME {
        const std::uint64_t refused = producer_.refused.load(std::memory_order_relaxed); // ring.lost_refused
        // Skipped is loaded before head; the consumer stores them in the other order: nothing counts twice.
        const std::uint64_t skipped = consumer_.skipped.load(std::memory_order_acquire); // ring.lost_skipped
        const std::uint64_t head = head_.load(std::memory_order_acquire);                // ring.lost_head
        const std::uint64_t fill = tail_.load(std::memory_order_acquire) - head;         // ring.lost_tail
        const std::uint64_t capacity = consumer_.place.capacity;
        return refused + skipped + (fill > capacity ? fill - capacity : 0);
    }

private:
    struct Place {
        Cell* cells = nullptr;
        std::uint64_t count = 0;
        std::uint64_t capacity = 0;
        Overflow overflow = Overflow::reject;
    };
    struct alignas(line_pair_bytes) Producer {
        Place place{};
        std::uint64_t position = 0; // values pushed
        std::uint64_t cell = 0;     // position % count
        std::uint64_t consumed = 0; // head_ when last loaded
        Atomic<std::uint64_t> high_water{};
        Atomic<std::uint64_t> refused{};
    };
    struct alignas(line_pair_bytes) Consumer {
        Place place{};
        std::uint64_t position = 0; // values popped or skipped
        std::uint64_t cell = 0;     // position % count
        std::uint64_t produced = 0; // tail_ when last loaded
        Atomic<std::uint64_t> skipped{};
    };

    // Raised before the value is published, because a value that is taken at once needed its room too. The
    // other side's index is loaded only when the fill could be a new maximum. So the mark is as exact as the
    // consumer's pace allows, never too small, and costs nothing once it is reached.
    void raise_mark() noexcept TAPPET_REALTIME {
        Producer& my = producer_;
        const std::uint64_t mark = my.high_water.load(std::memory_order_relaxed); // ring.mark_read
        if (mark == my.place.capacity || my.position - my.consumed <= mark) return;
        my.consumed = head_.load(std::memory_order_acquire); // ring.mark_look
        const std::uint64_t fill = std::min(my.position - my.consumed, my.place.capacity);
        if (fill > mark) my.high_water.store(fill, std::memory_order_relaxed); // ring.mark_raise
    }

    bool pop_oldest_left(T& into) noexcept TAPPET_REALTIME {
        Consumer& my = consumer_;
        for (std::size_t attempt = 0; attempt < attempts; ++attempt) {
            my.produced = tail_.load(std::memory_order_acquire); // ring.take_look
            if (my.position == my.produced) return false;
            if (my.produced - my.position > my.place.capacity) skip_to(my.produced - my.place.capacity);
            const Cell& cell = my.place.cells[my.cell];
            typename Value::Copy copy;
            cell.value.load(copy);
            if (cell.number.load(std::memory_order_relaxed) != my.position + 1) continue; // ring.take_check
            Value::unpack(copy, into);
            advance();
            return true;
        }
        return false;
    }

    void advance() noexcept TAPPET_REALTIME {
        Consumer& my = consumer_;
        ++my.position;
        my.cell = my.cell + 1 == my.place.count ? 0 : my.cell + 1;
        head_.store(my.position, std::memory_order_release); // ring.pop_release
    }

    void skip_to(std::uint64_t position) noexcept TAPPET_REALTIME {
        Consumer& my = consumer_;
        const std::uint64_t skipped = position - my.position;
        my.position = position;
        my.cell = position % my.place.count;
        head_.store(position, std::memory_order_release);                        // ring.skip_release
        const std::uint64_t before = my.skipped.load(std::memory_order_relaxed); // ring.skip_count
        my.skipped.store(before + skipped, std::memory_order_release);           // ring.skip_count
    }

    Producer producer_{};
    alignas(line_pair_bytes) Atomic<std::uint64_t> tail_{}; // values pushed, for the consumer
    Consumer consumer_{};
    alignas(line_pair_bytes) Atomic<std::uint64_t> head_{}; // values popped or skipped, for the producer
};

} // namespace tappet
