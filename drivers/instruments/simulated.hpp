// Instruments at the other end of the wires, for plants: their counts and signals, and their faults.
#pragma once

#include "drivers/instruments/analog.hpp"

#include <cmath>
#include <cstdint>

namespace tappet::instruments {

/// A scaled register of `bits` bits.
template <int bits>
class SimulatedEncoder {
    static_assert(bits >= 2 && bits <= 63);

public:
    /// `zero`: the position with count 0, in units.
    explicit constexpr SimulatedEncoder(double counts_per_unit, double zero = 0.0) noexcept
        : counts_per_unit_{counts_per_unit}, zero_{zero} {}
    /// Returns the register's contents at that position, unsigned.
    [[nodiscard]] std::uint64_t count(double position) noexcept {
        if (!is_stuck_) last_ = static_cast<std::int64_t>(std::floor((position - zero_) * counts_per_unit_));
        return static_cast<std::uint64_t>(last_ + slipped_) & ((std::uint64_t{1} << bits) - 1);
    }
    void stick(bool stuck) noexcept { is_stuck_ = stuck; }          ///< fault: its disk is loose
    void slip(std::int64_t counts) noexcept { slipped_ += counts; } ///< fault: it lost pulses

private:
    double counts_per_unit_, zero_;
    std::int64_t last_ = 0, slipped_ = 0;
    bool is_stuck_ = false;
};

/// A transmitter with a live zero.
class SimulatedTransmitter {
public:
    explicit constexpr SimulatedTransmitter(const AnalogScale& scale) noexcept : scale_{scale} {}
    /// Returns the transmitted signal, which exceeds the range as far as NE 43 permits.
    [[nodiscard]] double raw(double value) const noexcept {
        const double span = scale_.raw_high - scale_.raw_low;
        if (is_broken_) return scale_.raw_low - span / 4.0; // no current at all
        const double share = (scale_.raw(value) - scale_.raw_low) / span;
        return scale_.raw_low + span * std::min(std::max(share, -0.2 / 16.0), 16.5 / 16.0);
    }
    void break_wire(bool broken) noexcept { is_broken_ = broken; }

private:
    AnalogScale scale_;
    bool is_broken_ = false;
};

} // namespace tappet::instruments
