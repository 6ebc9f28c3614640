// A counter of few bits, unwrapped to a distance.
#pragma once

#include "kernel/base/realtime.hpp"

#include <cstdint>

namespace tappet {

/// The count of a register of 2 to 63 bits, unwrapped: between two samples it must move by less than half of
/// its range. The first sample after a begin, or after lose(), counts from the register itself, read as
/// signed. Real-time.
class UnwrappedCount {
public:
    /// Adds a sample. Returns the whole distance, in counts.
    constexpr std::int64_t take(std::int64_t code, int bits) noexcept TAPPET_REALTIME {
        // Unsigned, because a signed number must not wrap.
        const auto moved =
            static_cast<std::uint64_t>(code) - static_cast<std::uint64_t>(is_known_ ? last_ : 0);
        way_ = (is_known_ ? way_ : 0) + as_signed(moved, bits);
        last_ = code;
        is_known_ = true;
        return way_;
    }
    /// Samples were missed: it is unknown how often the register wrapped.
    constexpr void lose() noexcept TAPPET_REALTIME { is_known_ = false; }
    [[nodiscard]] constexpr bool is_known() const noexcept TAPPET_REALTIME { return is_known_; }

private:
    /// Returns the lowest bits, sign-extended.
    static constexpr std::int64_t as_signed(std::uint64_t code, int bits) noexcept TAPPET_REALTIME {
        const int above = 64 - bits;
        return static_cast<std::int64_t>(code << above) >> above;
    }

    std::int64_t way_ = 0, last_ = 0;
    bool is_known_ = false;
};

} // namespace tappet
