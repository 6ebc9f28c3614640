// The values of a bus's signals: decoded from frames that match the map, encoded into frames to send.
#pragma once

#include "drivers/can/signal_map.hpp"

namespace tappet::can {

enum class Decoded : std::uint8_t { yes, unknown_identifier, wrong_length };

struct DecodeCounters {
    std::uint64_t decoded = 0;
    std::uint64_t unknown_identifiers = 0; ///< never decoded
    std::uint64_t wrong_lengths = 0;       ///< or of another format than the row's; never decoded
    std::uint64_t saturated = 0;           ///< values to send that were out of their signal's range
    std::uint64_t refused = 0;             ///< values to send that were not numbers; the previous value stays
    bool operator==(const DecodeCounters&) const = default;
};

/// All calls but the constructor are real-time. `map` must outlive the store; signals are given by their
/// index.
template <std::size_t F, std::size_t S> class SignalStore {
public:
    explicit constexpr SignalStore(const SignalMap<F, S>& map) noexcept : map_{&map} {}

    /// Decodes a received frame, completely or not at all. `which` becomes its row.
    constexpr Decoded decode(const Frame& frame, std::size_t& which) noexcept TAPPET_REALTIME {
        const std::size_t f = map_->frame(Identifier{frame.id, frame.extended});
        if (f == no_such || map_->frames[f].direction != Direction::receive || frame.remote) {
            ++count.unknown_identifiers;
            return Decoded::unknown_identifier;
        }
        const FrameRow& row = map_->frames[f];
        if (frame.length != row.length || format_of(frame) != row.format) {
            ++count.wrong_lengths;
            return Decoded::wrong_length;
        }
        for (std::size_t s = row.first; s < row.end(); ++s)
            if (is_in(row, s, frame)) raw_[s] = extract(frame.data, map_->places[s]);
        ++count.decoded;
        which = f;
        return Decoded::yes;
    }
    constexpr Decoded decode(const Frame& frame) noexcept TAPPET_REALTIME {
        std::size_t which = no_such;
        return decode(frame, which);
    }
    /// Returns whether a received frame of the row holds the signal.
    [[nodiscard]] constexpr bool is_in(const FrameRow& row, std::size_t s, const Frame& frame) const noexcept
        TAPPET_REALTIME {
        return map_->holds(row, s, [&](std::size_t m) noexcept TAPPET_REALTIME {
            return extract(frame.data, map_->places[m]);
        });
    }
    /// Returns the frame of a row with the present values; of a multiplexed frame, the signals that these
    /// select. Its stamp is `now`.
    [[nodiscard]] constexpr Frame encode(std::size_t f, Time now) const noexcept TAPPET_REALTIME {
        const FrameRow& row = map_->frames[f];
        Frame frame = frame_of(row);
        frame.stamp = now;
        for (std::size_t s = row.first; s < row.end(); ++s)
            if (is_encoded(row, s)) insert(frame.data, map_->places[s], raw_[s]);
        return frame;
    }
    /// Returns whether encode() puts the signal of the row into its frame.
    [[nodiscard]] constexpr bool is_encoded(const FrameRow& row, std::size_t s) const noexcept
        TAPPET_REALTIME {
        return map_->holds(row, s, [this](std::size_t m) noexcept TAPPET_REALTIME { return raw_[m]; });
    }
    [[nodiscard]] constexpr double physical(std::size_t s) const noexcept TAPPET_REALTIME {
        return to_physical(map_->signals[s], raw_[s]);
    }
    /// Returns the whole number before factor and offset, for status words and counters.
    [[nodiscard]] constexpr std::int64_t integer(std::size_t s) const noexcept TAPPET_REALTIME {
        return to_integer(map_->signals[s], raw_[s]);
    }
    /// Returns how it was encoded; what is not a number is not set.
    constexpr Raw set_physical(std::size_t s, double value) noexcept TAPPET_REALTIME {
        return set(s, to_raw(map_->signals[s], value));
    }
    /// Sets a signal without factor and offset: a number limited to the signal's range, if any, else bits.
    constexpr Raw set_integer(std::size_t s, std::int64_t value) noexcept TAPPET_REALTIME {
        return set(s, to_raw_integer(map_->signals[s], value));
    }
    /// Sets a set of bits, such as a control word; bits beyond the signal's width are cut.
    constexpr void set_bits(std::size_t s, std::uint64_t bits) noexcept TAPPET_REALTIME {
        raw_[s] = bits & detail::mask_of(map_->signals[s]);
    }

    [[nodiscard]] constexpr const SignalMap<F, S>& map() const noexcept TAPPET_REALTIME { return *map_; }

    DecodeCounters count{};

private:
    constexpr Raw set(std::size_t s, const Raw& raw) noexcept TAPPET_REALTIME {
        if (raw.refused)
            ++count.refused;
        else
            raw_[s] = raw.bits;
        if (raw.saturated) ++count.saturated;
        return raw;
    }

    const SignalMap<F, S>* map_;
    std::array<std::uint64_t, S> raw_{};
};

} // namespace tappet::can
