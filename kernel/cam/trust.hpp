// Decides whether an encoder is trustworthy.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"

#include <algorithm>
#include <cstdint>

namespace tappet {

/// A code that the shaft could not have reached is a late frame; several in a row mean two shafts, and the
/// right one is unknown. Real-time.
class EncoderTrust {
public:
    /// Call after each sample with the number of implausible samples so far.
    constexpr void watch(std::uint64_t implausible, Time now) noexcept TAPPET_REALTIME {
        if (implausible == seen_) return;
        if (now - since_ > within) {
            since_ = now;
            before_ = seen_;
        }
        seen_ = implausible;
        if (implausible - before_ >= most) doubt_until(now + doubted);
    }
    /// Distrusts the encoder at least until that time, whatever the samples say.
    constexpr void doubt_until(Time time) noexcept TAPPET_REALTIME { until_ = std::max(until_, time); }
    [[nodiscard]] constexpr bool believes(Time now) const noexcept TAPPET_REALTIME { return now >= until_; }

    static constexpr std::uint64_t most = 4; ///< implausible samples
    static constexpr Duration within = 50ms;
    static constexpr Duration doubted = 200ms; ///< without another one it is trusted again
    static_assert(doubted > within, "an encoder that goes on jumping stays distrusted");

private:
    std::uint64_t seen_ = 0;
    std::uint64_t before_ = 0; // at the beginning of the window
    Time since_{};
    Time until_{};
};

} // namespace tappet
