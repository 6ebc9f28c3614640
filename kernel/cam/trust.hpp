// Whether an encoder is to be believed.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"

#include <algorithm>
#include <cstdint>

namespace tappet {

/// A code that no shaft could have reached is a late frame; some of them in a row are two shafts, and nobody
/// knows which of the two is ours. Real-time.
class EncoderTrust {
public:
    /// After each sample: how many were implausible so far.
    constexpr void watch(std::uint64_t implausible, Time now) noexcept TAPPET_REALTIME {
        if (implausible == seen_) return;
        if (now - since_ > within) {
            since_ = now;
            before_ = seen_;
        }
        seen_ = implausible;
        if (implausible - before_ >= most) doubt_until(now + doubted);
    }
    /// Not before that time, whatever the samples say.
    constexpr void doubt_until(Time time) noexcept TAPPET_REALTIME { until_ = std::max(until_, time); }
    [[nodiscard]] constexpr bool believes(Time now) const noexcept TAPPET_REALTIME { return now >= until_; }

    static constexpr std::uint64_t most = 4; ///< implausible samples
    static constexpr Duration within = 50ms;
    static constexpr Duration doubted = 200ms; ///< without another one it is believed again
    static_assert(doubted > within, "an encoder that goes on jumping stays distrusted");

private:
    std::uint64_t seen_ = 0;
    std::uint64_t before_ = 0; // the window's beginning
    Time since_{};
    Time until_{};
};

} // namespace tappet
