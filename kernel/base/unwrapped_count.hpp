// A counter of few bits that runs on, as a way.
#pragma once

#include "kernel/base/realtime.hpp"

#include <cstdint>

namespace tappet {

/// What a register of 2 to 63 bits counts, unwrapped: between two samples it moves by less than half of its
/// range. The first one after a begin, or after it was lost, counts from the register itself, taken as
/// signed. Real-time.
class UnwrappedCount {
public:
    /// The whole way, in counts.
    constexpr std::int64_t take(std::int64_t code, int bits) noexcept TAPPET_REALTIME {
        // Without a sign, which may not wrap.
        const auto moved =
            static_cast<std::uint64_t>(code) - static_cast<std::uint64_t>(is_known_ ? last_ : 0);
        way_ = (is_known_ ? way_ : 0) + as_signed(moved, bits);
        last_ = code;
        is_known_ = true;
        return way_;
    }
    /// Samples were missed: nobody knows how often it wrapped.
    constexpr void lose() noexcept TAPPET_REALTIME { is_known_ = false; }
    [[nodiscard]] constexpr bool is_known() const noexcept TAPPET_REALTIME { return is_known_; }

private:
    /// The lowest bits, with the sign of the highest of them.
    static constexpr std::int64_t as_signed(std::uint64_t code, int bits) noexcept TAPPET_REALTIME {
        const int above = 64 - bits;
        return static_cast<std::int64_t>(code << above) >> above;
    }

    std::int64_t way_ = 0, last_ = 0;
    bool is_known_ = false;
};

} // namespace tappet
