// The layout of a machine's recorded values (thesis 3.3, Reporting), for a reader in another process: the
// list of values, and a tape of them for each activity.
#pragma once

#include "kernel/exchange/word_tape.hpp"

#include <cstddef>
#include <cstdint>
#include <type_traits>

/// All offsets (`_at`) count bytes from the beginning of Directory, whose place is map::Header::report_at;
/// step through sections by their strides. Nothing here changes once the map is ready, except the tapes, by
/// their own rules, and the sequence numbers, while the generation of their activity is odd.
namespace tappet::recorded {

/// An index that refers to nothing.
inline constexpr std::uint32_t none = 0xffffffffu;

/// One recorded value. The samples of a channel are numbered from 0, so that a reader knows how many it
/// missed.
struct Channel {
    std::uint32_t component = 0; ///< of the map
    std::uint32_t facet = 0;     ///< within the component
    std::uint32_t bytes = 0;     ///< of its value
    std::uint32_t tape = 0;
    std::uint32_t every = 0; ///< the number of steps; 0: on change
    std::uint32_t trigger =
        none;                   ///< the channel of the event around which its samples count; none: all count
    double band = 0;            ///< the largest change that is not recorded
    std::int64_t before_ns = 0; ///< how long before the event, and after it, samples count
    std::int64_t after_ns = 0;
    std::uint64_t next_at = 0;  ///< uint32: the number of its next sample
    std::uint32_t is_event = 0; ///< 1: the facet is an event, and the value is its number of emissions
    std::uint32_t reserved = 0;
};

struct Tape {
    std::uint64_t at = 0; ///< ValueTape
    std::uint32_t activity = 0;
    std::uint32_t reserved = 0;
};

struct Directory {
    std::uint64_t bytes = 0; ///< of everything here
    std::uint64_t channels_at = 0;
    std::uint32_t channels = 0;
    std::uint32_t channel_stride = sizeof(Channel);
    std::uint64_t tapes_at = 0;
    std::uint32_t tapes = 0; ///< one for each activity with recorded values
    std::uint32_t tape_stride = sizeof(Tape);
};

template <class Record>
inline constexpr bool is_plain =
    std::is_trivially_copyable_v<Record> && std::is_standard_layout_v<Record> && alignof(Record) <= 8;
static_assert(is_plain<Channel> && is_plain<Tape> && is_plain<Directory>);

/// The most bytes of a recorded value, and the most channels of a machine.
inline constexpr std::size_t most_value_bytes = 4096;
inline constexpr std::size_t most_channels = 4096;
/// The most events that windows may have.
inline constexpr std::size_t most_triggers = 64;

/// The first word of a sample; the words of its value follow.
struct SampleHead {
    std::uint32_t channel = 0;
    std::uint32_t words = 0;    ///< of the value
    std::uint32_t sequence = 0; ///< of the channel

    [[nodiscard]] constexpr std::uint64_t word() const noexcept {
        return std::uint64_t{channel} << 48 | std::uint64_t{words} << 32 | sequence;
    }
    [[nodiscard]] static constexpr SampleHead of(std::uint64_t word) noexcept {
        return {static_cast<std::uint32_t>(word >> 48), static_cast<std::uint32_t>(word >> 32 & 0xffff),
                static_cast<std::uint32_t>(word)};
    }
};

constexpr std::size_t words_of(std::size_t bytes) noexcept { return (bytes + 7) / 8; }

/// The samples of one cycle on a tape, followed by the time of the cycle and the number of all its words. It
/// is read from its end.
struct Moment {
    static constexpr std::size_t words_beside_samples = 2;

    std::int64_t at_ns = 0;  ///< of the machine's clock
    std::uint64_t at = 0;    ///< position of its first word
    std::uint64_t after = 0; ///< position after its last word

    [[nodiscard]] std::size_t sample_words() const noexcept {
        return static_cast<std::size_t>(after - at) - words_beside_samples;
    }
};

/// A tape of values, written by one engine at the end of its cycles.
class ValueTape : public WordTape {
public:
    [[nodiscard]] static constexpr std::size_t bytes_for(std::size_t words) noexcept {
        return sizeof(ValueTape) + words * sizeof(std::uint64_t);
    }
    /// Construct it at the beginning of bytes_for(words) bytes.
    ValueTape(std::size_t words, std::size_t most_words) noexcept : WordTape{words, most_words} {}

    /// For the engine: begin(), a put() for each word, end(). Real-time.
    using WordTape::Pen;
    [[nodiscard]] Pen begin() noexcept TAPPET_REALTIME { return pen(); }
    /// Ends a cycle. A cycle without a sample leaves nothing on the tape.
    void end(Pen pen, std::int64_t at_ns) noexcept TAPPET_REALTIME {
        if (pen.at() == position()) return;
        pen.put(static_cast<std::uint64_t>(at_ns));
        pen.put(pen.at() + 1 - position());
        publish(pen.at());
    }

    /// Returns the moment that ends at `after`: head(), or the `at` of the following moment. False: there is
    /// none, or it is overwritten.
    [[nodiscard]] bool moment_before(std::uint64_t after, Moment& moment) const noexcept {
        if (after < Moment::words_beside_samples || after > head()) return false;
        const std::uint64_t words = get(after - 1);
        moment = {static_cast<std::int64_t>(get(after - 2)), after - words, after};
        return words > Moment::words_beside_samples && words <= after && words <= most_words() &&
               holds(moment.at);
    }
};
static_assert(sizeof(ValueTape) == sizeof(WordTape), "its words lie after it");

} // namespace tappet::recorded
