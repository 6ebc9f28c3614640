// The layout of a machine's cycle records: one tape for each activity, and places for the worst cycles with
// everything around them. It is flat and uses offsets, so that another process can read it.
#pragma once

#include "kernel/activity/cycle_tape.hpp"

#include <cstdint>
#include <type_traits>

/// All offsets (`_at`) count bytes from the beginning of Directory, whose place is map::Header::scope_at. A
/// reader in another process relies on the version of kernel/machine/map/layout.hpp; it steps through
/// sections by their strides.
namespace tappet::scope {

/// The span is divided into generations - 1 parts; the oldest generation gives its places to the new one. So
/// the worst cycles of at least the whole span are available at any time.
inline constexpr std::uint32_t generations = 4;
/// The number of worst cycles kept in each generation for each ranked activity.
inline constexpr std::uint32_t kept = 2;
/// The most words of one recording, including everything around the cycle.
inline constexpr std::uint32_t recording_words = 224;

struct Tape {
    std::uint64_t at = 0;     ///< CycleTape
    std::uint32_t ranked = 0; ///< 1: its worst cycles are kept, because it is real-time
    std::uint32_t reserved = 0;
    std::uint64_t judged_until = 0; ///< position on the tape after the last judged cycle
};

/// A kept cycle. `words` words follow it: for each activity that ran between `from` and `to` one word,
/// activity << 48
/// the number of words that follow, then its cycles, oldest first, as on its tape.
struct Recording {
    std::uint64_t serial = 0;     ///< of the place's contents; 0: it is empty
    std::uint64_t generation = 0; ///< the number of the part of the span, since the clock's zero
    std::uint32_t activity = 0;
    std::uint32_t words = 0;
    std::int64_t rank_ns = 0; ///< its response or its busy time, by which it is ranked
    std::int64_t release = 0;
    std::int64_t begin = 0;
    std::int64_t end = 0;
    std::int64_t from = 0; ///< of the surroundings: less than requested when they need more than the place
    std::int64_t to = 0;
};

/// The tapes follow their own rules; everything else here changes only while the generation of activity
/// `owner` is odd.
struct Directory {
    std::uint64_t bytes = 0;           ///< of everything here
    std::uint32_t owner = 0xffffffffu; ///< the activity that keeps the worst cycles
    std::uint32_t by_busy = 0;         ///< 1: ranked by busy time; 0: by response
    std::uint64_t tapes_at = 0;
    std::uint32_t tapes = 0; ///< one for each activity, in the table's order
    std::uint32_t tape_stride = sizeof(Tape);
    std::uint64_t recordings_at = 0;
    std::uint32_t recordings = 0;
    std::uint32_t recording_stride = 0; ///< in bytes, the words included
    std::int64_t stamp_ns = 0;          ///< cost of one time stamp, which each function's time includes once
    std::int64_t span_ns = 0;           ///< for which the worst cycles are kept
    std::int64_t looked_ns = 0;         ///< cycles that ended before it have been judged
    std::uint64_t judged = 0;           ///< cycles of the ranked activities
    std::uint64_t taken = 0;            ///< recordings, including those that were replaced
    std::uint64_t overtaken = 0;        ///< how often a tape was overwritten before it was read
};

template <class Record>
inline constexpr bool is_plain =
    std::is_trivially_copyable_v<Record> && std::is_standard_layout_v<Record> && alignof(Record) <= 8;
static_assert(is_plain<Tape> && is_plain<Recording> && is_plain<Directory>);

inline constexpr std::size_t recording_bytes = sizeof(Recording) + recording_words * sizeof(std::uint64_t);

[[nodiscard]] inline Tape* tapes(Directory& directory) noexcept {
    return reinterpret_cast<Tape*>(reinterpret_cast<std::byte*>(&directory) + directory.tapes_at);
}
[[nodiscard]] inline CycleTape& tape(Directory& directory, std::size_t activity) noexcept {
    return *reinterpret_cast<CycleTape*>(reinterpret_cast<std::byte*>(&directory) +
                                         tapes(directory)[activity].at);
}
[[nodiscard]] inline Recording& recording(Directory& directory, std::size_t index) noexcept {
    return *reinterpret_cast<Recording*>(reinterpret_cast<std::byte*>(&directory) + directory.recordings_at +
                                         index * directory.recording_stride);
}
[[nodiscard]] inline std::uint64_t* words_of(Recording& recording) noexcept {
    return reinterpret_cast<std::uint64_t*>(&recording + 1);
}

} // namespace tappet::scope
