// The tape of one activity (thesis A.2.1): the functions that ran in each of its last cycles, with their
// times. The engine writes it from stamps that it needs anyway. Readers, from any process, do not disturb it.
#pragma once

#include "kernel/exchange/word_tape.hpp"

#include <cstddef>
#include <cstdint>

namespace tappet {

/// A cycle on a tape, in words of 64 bits: one mark for each function in the order in which they ran, then
/// release, begin, and a word with the end and the number of marks. It is read from its end, so that the last
/// cycles are found first. Times are those of the machine's clock, in ns.
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

/// The end of an engine's function, after its cycle's begin. It began when the mark before it ended.
struct TapeMark {
    static constexpr unsigned time_bits = 44; ///< nearly five hours
    static constexpr std::uint64_t time_mask = (std::uint64_t{1} << time_bits) - 1;

    std::uint32_t function = 0; ///< number of the function, as for FunctionTiming
    std::int64_t end = 0;       ///< ns after the begin of the cycle

    [[nodiscard]] constexpr std::uint64_t word() const noexcept {
        return std::uint64_t{function} << time_bits | (static_cast<std::uint64_t>(end) & time_mask);
    }
    [[nodiscard]] static constexpr TapeMark of(std::uint64_t word) noexcept {
        return {static_cast<std::uint32_t>(word >> time_bits), static_cast<std::int64_t>(word & time_mask)};
    }
};

/// Returns the cycle whose last three words these are. It checks nothing; readers check only its numbers.
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

/// Written by one engine, wait-free: one store for each function, four for each cycle.
class CycleTape : public WordTape {
public:
    static constexpr std::size_t fewest_words = 64;
    static constexpr std::uint32_t most_marks_ever = 4095;

    [[nodiscard]] static constexpr std::size_t bytes_for(std::size_t words) noexcept {
        return sizeof(CycleTape) + words * sizeof(std::uint64_t);
    }
    /// Constructed at the beginning of bytes_for(words); `words`: a power of two, at least fewest_words.
    explicit CycleTape(std::size_t words) noexcept
        : WordTape{words, most_marks_of(words) + TapeCycle::words_beside_marks},
          most_marks_{most_marks_of(words)} {}

    /// For the engine, in this order. Real-time.
    void begin() noexcept TAPPET_REALTIME { marks_ = left_out_ = 0; }
    void mark(std::uint32_t function, std::int64_t ns_after_begin) noexcept TAPPET_REALTIME {
        if (marks_ == most_marks_) {
            left_out_ += left_out_ < 255 ? 1 : 0;
            return;
        }
        put(position() + marks_, TapeMark{function, ns_after_begin}.word());
        ++marks_;
    }
    void end(std::int64_t release, std::int64_t begin, std::int64_t end) noexcept TAPPET_REALTIME {
        const std::uint64_t summary = std::uint64_t{marks_} << 52 |
                                      std::uint64_t{left_out_} << TapeMark::time_bits |
                                      (static_cast<std::uint64_t>(end - begin) & TapeMark::time_mask);
        const std::uint64_t at = position() + marks_;
        put(at, static_cast<std::uint64_t>(release));
        put(at + 1, static_cast<std::uint64_t>(begin));
        put(at + 2, summary);
        publish(at + TapeCycle::words_beside_marks);
    }

    /// Gets the cycle that ends at `after`: head(), or the `at` of the cycle after it. Returns false when
    /// there is none, or when it is overwritten.
    [[nodiscard]] bool cycle_before(std::uint64_t after, TapeCycle& cycle) const noexcept {
        if (after < TapeCycle::words_beside_marks || after > head()) return false;
        cycle = cycle_of(get(after - 3), get(after - 2), get(after - 1), after);
        return cycle.marks + TapeCycle::words_beside_marks <= after && holds(cycle.at);
    }

private:
    static constexpr std::uint32_t most_marks_of(std::size_t words) noexcept {
        return static_cast<std::uint32_t>(words / 8 < most_marks_ever ? words / 8
                                                                      : std::size_t{most_marks_ever});
    }

    std::uint32_t most_marks_;
    std::uint32_t marks_ = 0;
    std::uint32_t left_out_ = 0;
};
static_assert(sizeof(CycleTape) == sizeof(WordTape), "its words lie after it");

} // namespace tappet
