// The tape of one activity (thesis A.2.1): which functions ran in each of its last cycles, and when. The
// engine writes it from the stamps that it takes anyway; whoever reads it, from whatever process, is noticed
// by nobody.
#pragma once

#include "kernel/base/realtime.hpp"

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <new>
#include <span>

namespace tappet {

/// A cycle on a tape is, in words of 64 bits: one mark for each function in the order in which they ran, then
/// release, begin, and a word of the end and of how many marks there are. It is read from its end, so that
/// the last cycles are found first. Times are those of the machine's clock, in ns.
struct TapeCycle {
    static constexpr std::size_t words_beside_marks = 3;

    std::int64_t release = 0;
    std::int64_t begin = 0;
    std::int64_t end = 0; ///< of the last function
    std::uint32_t marks = 0;
    std::uint32_t left_out = 0; ///< functions for which the cycle had no room; 255: or more
    std::uint64_t at = 0;       ///< position of its first mark
    std::uint64_t after = 0;    ///< position after its last word

    [[nodiscard]] std::int64_t response() const noexcept { return end - release; }
    [[nodiscard]] std::int64_t busy() const noexcept { return end - begin; }
    [[nodiscard]] std::size_t words() const noexcept { return static_cast<std::size_t>(after - at); }
};

/// A function of the engine that ended so long after its cycle's begin. It began when the mark before it
/// ended.
struct TapeMark {
    static constexpr unsigned time_bits = 44; ///< nearly five hours
    static constexpr std::uint64_t time_mask = (std::uint64_t{1} << time_bits) - 1;

    std::uint32_t function = 0; ///< as FunctionTiming is numbered
    std::int64_t end = 0;       ///< ns after the begin of the cycle

    [[nodiscard]] constexpr std::uint64_t word() const noexcept {
        return std::uint64_t{function} << time_bits | (static_cast<std::uint64_t>(end) & time_mask);
    }
    [[nodiscard]] static constexpr TapeMark of(std::uint64_t word) noexcept {
        return {static_cast<std::uint32_t>(word >> time_bits), static_cast<std::int64_t>(word & time_mask)};
    }
};

/// The cycle whose last three words these are; nothing but its numbers is checked by who reads.
[[nodiscard]] constexpr TapeCycle cycle_of(std::uint64_t release, std::uint64_t begin, std::uint64_t summary,
                                           std::uint64_t after) noexcept {
    TapeCycle cycle;
    cycle.release = static_cast<std::int64_t>(release);
    cycle.begin = static_cast<std::int64_t>(begin);
    cycle.end = cycle.begin + static_cast<std::int64_t>(summary & TapeMark::time_mask);
    cycle.marks = static_cast<std::uint32_t>(summary >> 52);
    cycle.left_out = static_cast<std::uint32_t>(summary >> TapeMark::time_bits & 0xff);
    cycle.at = after - TapeCycle::words_beside_marks - cycle.marks;
    cycle.after = after;
    return cycle;
}

/// Written by one engine, wait-free: one store for each function, four for each cycle, no load of what
/// another wrote, and no line that a reader polls. It overwrites its oldest cycles without asking; a reader
/// finds out afterwards whether what it read still stood there. Its words lie after it.
///
/// Proof that no torn cycle is handed out: all words are stored with release and loaded with acquire. A
/// reader that loads a word of a later round than it meant therefore sees in head() at least the position at
/// which that later cycle began, which is less than most_words() before the word; holds() is then false.
class CycleTape {
    static constexpr std::size_t apart = 128; // two lines: the processor fetches them in pairs

public:
    static constexpr std::size_t fewest_words = 64;
    static constexpr std::uint32_t most_marks_ever = 4095;
    static constexpr std::size_t alignment = apart;

    [[nodiscard]] static constexpr std::size_t bytes_for(std::size_t words) noexcept {
        return sizeof(CycleTape) + words * sizeof(std::uint64_t);
    }
    /// At the beginning of bytes_for(words); `words`: a power of two, at least fewest_words.
    explicit CycleTape(std::size_t words) noexcept
        : capacity_{words},
          most_marks_{static_cast<std::uint32_t>(
              words / 8 < most_marks_ever ? words / 8 : std::size_t{most_marks_ever})} {
        for (std::size_t i = 0; i < words; ++i)
            ::new (static_cast<void*>(first() + i)) std::atomic<std::uint64_t>{0};
    }
    CycleTape(const CycleTape&) = delete;
    CycleTape& operator=(const CycleTape&) = delete;

    /// Whether cycles are recorded; any thread, at any time: it holds from the next cycle on.
    void turn(bool on) noexcept TAPPET_REALTIME {
        on_.store(on, std::memory_order_relaxed); // no step: it holds from the next cycle on
    }
    [[nodiscard]] bool is_on() const noexcept TAPPET_REALTIME {
        return on_.load(std::memory_order_relaxed); // no step: it holds from the next cycle on
    }

    /// The engine's, in this order. Real-time.
    void begin() noexcept TAPPET_REALTIME { marks_ = left_out_ = 0; }
    void mark(std::uint32_t function, std::int64_t ns_after_begin) noexcept TAPPET_REALTIME {
        if (marks_ == most_marks_) {
            left_out_ += left_out_ < 255 ? 1 : 0;
            return;
        }
        put(position_ + marks_, TapeMark{function, ns_after_begin}.word());
        ++marks_;
    }
    void end(std::int64_t release, std::int64_t begin, std::int64_t end) noexcept TAPPET_REALTIME {
        const std::uint64_t summary = std::uint64_t{marks_} << 52 |
                                      std::uint64_t{left_out_} << TapeMark::time_bits |
                                      (static_cast<std::uint64_t>(end - begin) & TapeMark::time_mask);
        const std::uint64_t at = position_ + marks_;
        put(at, static_cast<std::uint64_t>(release));
        put(at + 1, static_cast<std::uint64_t>(begin));
        put(at + 2, summary);
        position_ = at + TapeCycle::words_beside_marks;
        head_.store(position_, std::memory_order_release); // tape.head
    }

    /// After the last complete cycle; any thread, any process.
    [[nodiscard]] std::uint64_t head() const noexcept {
        return head_.load(std::memory_order_acquire); // tape.look
    }
    [[nodiscard]] std::size_t capacity() const noexcept { return capacity_; }
    /// Of one cycle.
    [[nodiscard]] std::size_t most_words() const noexcept {
        return most_marks_ + TapeCycle::words_beside_marks;
    }
    /// What was read from `at` on was not overwritten meanwhile; asked after reading.
    [[nodiscard]] bool holds(std::uint64_t at) const noexcept {
        return at + capacity_ >= head() + most_words(); // tape.check
    }
    /// The cycle that ends where `after` says: head(), or the `at` of the cycle after it. False: there is
    /// none, or it is overwritten.
    [[nodiscard]] bool cycle_before(std::uint64_t after, TapeCycle& cycle) const noexcept {
        if (after < TapeCycle::words_beside_marks || after > head()) return false;
        cycle = cycle_of(get(after - 3), get(after - 2), get(after - 1), after);
        return cycle.marks + TapeCycle::words_beside_marks <= after && holds(cycle.at);
    }
    /// Words from `at` on, as many as `into` has room for. False: they are not there any more.
    [[nodiscard]] bool copy(std::uint64_t at, std::span<std::uint64_t> into) const noexcept {
        if (at + into.size() > head()) return false;
        for (std::size_t i = 0; i < into.size(); ++i) into[i] = get(at + i);
        return holds(at);
    }

private:
    [[nodiscard]] std::atomic<std::uint64_t>* first() noexcept TAPPET_REALTIME {
        return reinterpret_cast<std::atomic<std::uint64_t>*>(this + 1);
    }
    [[nodiscard]] const std::atomic<std::uint64_t>* first() const noexcept {
        return reinterpret_cast<const std::atomic<std::uint64_t>*>(this + 1);
    }
    void put(std::uint64_t at, std::uint64_t word) noexcept TAPPET_REALTIME {
        first()[at & (capacity_ - 1)].store(word, std::memory_order_release); // tape.word
    }
    [[nodiscard]] std::uint64_t get(std::uint64_t at) const noexcept {
        return first()[at & (capacity_ - 1)].load(std::memory_order_acquire); // tape.take
    }

    // Read by everybody, written as good as never.
    alignas(apart) std::uint64_t capacity_;
    std::uint32_t most_marks_;
    std::atomic<bool> on_{true};
    // What readers poll.
    alignas(apart) std::atomic<std::uint64_t> head_{0};
    // The engine's own.
    alignas(apart) std::uint64_t position_ = 0;
    std::uint32_t marks_ = 0;
    std::uint32_t left_out_ = 0;
};
static_assert(sizeof(CycleTape) == 3 * CycleTape::alignment &&
              std::atomic<std::uint64_t>::is_always_lock_free);

} // namespace tappet
