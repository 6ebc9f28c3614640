// Proves and measures the processor's counter, and re-reads the clock before stamps could drift from it.
#include "kernel/os/stamps.hpp"

#include "kernel/os/sleep.hpp"
#include "kernel/os/system_file.hpp"

#include <algorithm>
#include <atomic>

#if defined(__x86_64__)
#include <cpuid.h>
#endif

namespace tappet::os {

namespace {

/// 0: the counter is not used
std::atomic<std::uint64_t> proven_ns_per_tick{0};

// The clock may be slewed, by 500 ppm under NTP, and the measurement is accurate to less than 100 ppm. The
// counter's rate is therefore taken as too slow, so that stamps do not run ahead of the clock. If the clock
// is slewed more, or its rate stepped, stamps may stand still for a while.
constexpr std::uint64_t ppm = 1'000'000, slower_by_ppm = 600, slewed_by_ppm = 500;
// If two readings of the counter are further apart, something else ran in between: the pair is discarded.
constexpr Duration most_between = 300ns;
static_assert(most_between + Stamps::window * (slower_by_ppm + slewed_by_ppm) / ppm < Stamps::most_behind);

bool counter_is_invariant() noexcept {
#if defined(__x86_64__)
    constexpr unsigned advanced_power_management = 0x80000007, invariant_bit = 1u << 8;
    unsigned a = 0, b = 0, c = 0, d = 0;
    return __get_cpuid(advanced_power_management, &a, &b, &c, &d) != 0 && (d & invariant_bit) != 0;
#else
    return false;
#endif
}

} // namespace

bool prove_processor_counter(std::string_view root) noexcept {
    const SystemFile source{root,
                            Sentence{"/sys/devices/system/clocksource/clocksource0/current_clocksource"}};
    proven_ns_per_tick.store(0, std::memory_order_relaxed);
    if (source.text() != "tsc" || !counter_is_invariant()) return false;
    struct Pair {
        Time time{};
        std::uint64_t ticks = 0;
    };
    // The quickest of several readings: an interruption makes a reading slow.
    const auto read = []() noexcept {
        Pair best;
        std::uint64_t least = ~std::uint64_t{0};
        for (int i = 0; i < 32; ++i) {
            const std::uint64_t before = Stamps::ticks();
            const Time time = Clock::monotonic();
            const std::uint64_t after = Stamps::ticks();
            if (after - before < least) least = after - before, best = {time, before + (after - before) / 2};
        }
        return best;
    };
    constexpr Duration apart = 5ms;
    const Pair first = read();
    sleep_for(apart);
    const Pair last = read();
    const auto passed = static_cast<std::uint64_t>((last.time - first.time).count());
    if (last.ticks <= first.ticks || passed < static_cast<std::uint64_t>(apart.count())) return false;
    const std::uint64_t rate = (passed << Stamps::fraction_bits) / (last.ticks - first.ticks);
    proven_ns_per_tick.store(rate - rate * slower_by_ppm / ppm, std::memory_order_relaxed);
    return true;
}

Time Stamps::look_at_clock() noexcept TAPPET_REALTIME {
    close_window();
    ns_per_tick_ = proven_ns_per_tick.load(std::memory_order_relaxed); // no step: nothing else hangs on it
    if (ns_per_tick_ == 0) return std::max(clock_->now(), floor_);
    const std::uint64_t before = ticks();
    const Time now = clock_->now();
    if (now < floor_) return floor_;
    const std::uint64_t after = ticks();
    floor_ = now;
    if (after - before > (std::uint64_t{1} << fraction_bits) || in_ns(after - before) > most_between)
        return now;
    anchor_ = now;
    anchor_ticks_ = after;
    ticks_of_window_ = (static_cast<std::uint64_t>(window.count()) << fraction_bits) / ns_per_tick_;
    return now;
}

} // namespace tappet::os
