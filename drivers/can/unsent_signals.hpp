// Counts, by signal, the values that a bus did not send as they were written, or received and did not pass
// on.
#pragma once

#include "drivers/can/signal.hpp"
#include "kernel/component/wire_counters.hpp"

namespace tappet::can {

/// Since the machine's start: a component that starts again keeps it. Real-time, but for of().
template <std::size_t S> class UnsentSignals {
public:
    /// The value of a signal was stored so, to be sent. One that is not a number is counted now.
    void stored(std::size_t s, const Raw& raw) noexcept TAPPET_REALTIME {
        clamped_[s] = raw.saturated;
        if (raw.refused) count(s, false);
    }
    /// The stored value was sent. It is counted when it was the nearest bound.
    void sent(std::size_t s) noexcept TAPPET_REALTIME {
        if (clamped_[s]) count(s, true);
    }
    /// A received value was not a number: it is not passed on, and does not count among those sent.
    void received_no_number(std::size_t s) noexcept TAPPET_REALTIME { counts_[s].count(false, true); }
    /// Returns the counts of a signal. Any thread.
    [[nodiscard]] Unsent of(std::size_t s) const noexcept { return counts_[s].read(); }
    /// Returns the sum of the counts of what was sent.
    [[nodiscard]] std::int64_t all() const noexcept TAPPET_REALTIME { return all_; }

private:
    void count(std::size_t s, bool is_clamped) noexcept TAPPET_REALTIME {
        counts_[s].count(is_clamped, !is_clamped);
        ++all_;
    }
    std::array<bool, S> clamped_{}; ///< the stored value is the nearest bound of the one written
    std::array<Unsent, S> counts_{};
    std::int64_t all_ = 0;
};

} // namespace tappet::can
