// Time stamps of one thread: from the processor's counter where it is proven to be as good as the kernel's
// clock, else from the clock. A stamp costs a third of a reading of the clock.
#pragma once

#include "kernel/os/clock.hpp"

#include <cstdint>
#include <string_view>

namespace tappet::os {

/// Lets all Stamps of the process use the processor's counter, if it is invariant and the same on all
/// processors: then the kernel itself takes its time from it, and monitors it. Measures the rate for some
/// milliseconds. `root` is a prefix of the kernel's files. Returns whether it is used. Not real-time.
bool prove_processor_counter(std::string_view root = {}) noexcept;

/// The stamps of one thread, of CLOCK_MONOTONIC or of virtual time. A stamp is never before the previous one.
/// While the clock is slewed by no more than NTP's 500 ppm, no stamp is ahead of it, and each is less than
/// most_behind behind it.
class Stamps {
public:
    static constexpr Duration most_behind = 600ns;
    /// Time for which the counter is used after one reading of the clock.
    static constexpr Duration window = 200us;

    void place(const Clock& clock) noexcept {
        clock_ = &clock;
        floor_ = Time::min();
        ticks_of_window_ = 0;
    }

    /// Makes the next stamp a reading of the clock: after a wait for a time, so that the time has come.
    void renew() noexcept TAPPET_REALTIME { close_window(); }

    [[nodiscard]] Time now() noexcept TAPPET_REALTIME {
        if (clock_->is_virtual()) return clock_->now();
        if (ticks_of_window_ != 0) [[likely]] {
            const std::uint64_t passed = ticks() - anchor_ticks_;
            if (passed < ticks_of_window_) [[likely]]
                return anchor_ + in_ns(passed);
        }
        return look_at_clock();
    }

private:
    static constexpr int fraction_bits = 32;

    static std::uint64_t ticks() noexcept TAPPET_REALTIME {
#if defined(__x86_64__)
        return __builtin_ia32_rdtsc();
#else
        return 0; // the proof fails: the clock is read
#endif
    }
    [[nodiscard]] Duration in_ns(std::uint64_t count) const noexcept TAPPET_REALTIME {
        return Duration{static_cast<std::int64_t>(count * ns_per_tick_ >> fraction_bits)};
    }
    /// Ends the use of the counter: no earlier stamp is after `floor_`.
    void close_window() noexcept TAPPET_REALTIME {
        if (ticks_of_window_ == 0) return;
        const std::uint64_t passed = ticks() - anchor_ticks_;
        floor_ = anchor_ + in_ns(passed < ticks_of_window_ ? passed : ticks_of_window_);
        ticks_of_window_ = 0;
    }
    Time look_at_clock() noexcept TAPPET_REALTIME;
    friend bool prove_processor_counter(std::string_view root) noexcept;

    const Clock* clock_ = nullptr;
    Time anchor_{};
    Time floor_ = Time::min();
    std::uint64_t anchor_ticks_ = 0;
    std::uint64_t ticks_of_window_ = 0; ///< 0: the clock is read each time
    std::uint64_t ns_per_tick_ = 0;     ///< with fraction_bits
};

} // namespace tappet::os
