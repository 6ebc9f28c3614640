// Multiplexed signals: which of a frame's signals are in it, told by the values of others in the same frame.
#pragma once

#include "drivers/can/signal.hpp"

#include <cstddef>

namespace tappet::can {

inline constexpr std::size_t no_such = ~std::size_t{0};

/// The signals of a map and the place of each one's multiplexor, which stands before it: so every way up
/// ends.
struct Multiplexing {
    std::span<const Signal> signals{};
    std::span<const std::size_t> multiplexor_of{}; ///< no_such: it always is in its frame

    /// Whether a frame holds the signal; raw_of(m) is the value there of a multiplexor. Real-time.
    template <class RawOf>
    [[nodiscard]] constexpr bool holds(std::size_t s, const RawOf& raw_of) const noexcept TAPPET_REALTIME {
        for (std::size_t at = s, up = multiplexor_of[s]; up != no_such; at = up, up = multiplexor_of[at])
            if (!signals[at].is_selected_by(raw_of(up))) return false;
        return true;
    }
    /// No frame holds both: somewhere above them the same multiplexor selects either.
    [[nodiscard]] constexpr bool exclude_each_other(std::size_t a, std::size_t b) const noexcept {
        for (std::size_t x = a; multiplexor_of[x] != no_such; x = multiplexor_of[x])
            for (std::size_t y = b; multiplexor_of[y] != no_such; y = multiplexor_of[y])
                if (multiplexor_of[x] == multiplexor_of[y] && !share_a_value(signals[x], signals[y]))
                    return true;
        return false;
    }

private:
    static constexpr bool share_a_value(const Signal& a, const Signal& b) noexcept {
        for (const Selection& one : a.selections)
            for (const Selection& other : b.selections)
                if (one.from <= other.to && other.from <= one.to) return true;
        return false;
    }
};

} // namespace tappet::can
