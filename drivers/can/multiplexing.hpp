// Multiplexed signals: the values of other signals in the same frame select which signals the frame holds.
#pragma once

#include "drivers/can/signal.hpp"

#include <cstddef>

namespace tappet::can {

/// The signals of a map, each with the index of its multiplexor, which is lower, so that every chain ends.
struct Multiplexing {
    std::span<const Signal> signals{};
    std::span<const std::size_t> multiplexor_of{}; ///< no_such: it is in every frame

    /// Returns whether a frame holds the signal; raw_of(m) is the value of multiplexor m in it. Real-time.
    template <class RawOf>
    [[nodiscard]] constexpr bool holds(std::size_t s, const RawOf& raw_of) const noexcept TAPPET_REALTIME {
        for (std::size_t at = s, up = multiplexor_of[s]; up != no_such; at = up, up = multiplexor_of[at])
            if (!signals[at].is_selected_by(raw_of(up))) return false;
        return true;
    }
    /// Returns whether no frame holds both: some common multiplexor selects one or the other.
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
