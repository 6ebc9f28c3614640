// Totals that survive power-off: components whose total is a property stored in a file.
//     component<HourMeter>("spindle_hours", properties_file("spindle_hours.cpf", optional))
//     component<Total>("pieces", properties_file("pieces.cpf", optional))
//     component<PropertyKeeper>("keeper", set("every", 60s))   // maximum loss at a power cut
// Files are written at an orderly halt, on request, and at a keeper's interval.
#pragma once

#include "kernel/component/component.hpp"

#include <algorithm>
#include <limits>

namespace tappet {

/// Measures the running time of something. Real-time, in a periodic activity.
struct HourMeter {
    Input<bool> runs;
    Output<double> hours;
    Property<Duration> total{};

    void start(const Cycle&) noexcept TAPPET_REALTIME {
        last_ = never;
        tell();
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        const bool counts = runs.good() && runs.get();
        if (counts && last_ != never)
            total.set(std::min(most, (Time{total.get()} + (cycle.now - last_)).time_since_epoch()));
        last_ = counts ? cycle.now : never;
        if (counts) tell();
    }

    static constexpr auto interface() {
        return facets(
            input<&HourMeter::runs>("runs", "", "it is counted while this is true, and not stale"),
            output<&HourMeter::hours>("hours", "h", "since it was built"),
            property<&HourMeter::total>("total", "s", "since it was built", range(0, to_seconds(most))));
    }

private:
    void tell() noexcept TAPPET_REALTIME { hours.write(to_seconds(total.get()) / 3600.0); }
    static constexpr Duration most = 9'000'000'000s; ///< maximum of a Duration, rounded
    Time last_ = never;
};

/// Sums up a count that restarts at 0 with its source: pieces, strokes, stops. Counts made while this
/// component is stopped are added when it runs again. A forced count is counted, too. Real-time.
struct Total {
    Input<std::int64_t> count;
    Output<std::int64_t> sum;
    Property<std::int64_t> total{0};

    void start(const Cycle&) noexcept TAPPET_REALTIME { sum.write(total.get()); }
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        std::int64_t now = 0;
        if (count.read(now) != Flow::fresh) return;
        std::int64_t more = 0, all = 0;
        if (now < counted_ || __builtin_sub_overflow(now, counted_, &more)) more = now; // it restarted
        counted_ = now;
        if (more <= 0) return;
        if (__builtin_add_overflow(total.get(), more, &all)) all = std::numeric_limits<std::int64_t>::max();
        total.set(all);
        sum.write(total.get());
    }

    static constexpr auto interface() {
        return facets(input<&Total::count>("count", "", "since the start; a smaller one began anew"),
                      output<&Total::sum>("sum", "", "since it was built"),
                      property<&Total::total>("total", "", "since it was built"));
    }

private:
    std::int64_t counted_ = 0; ///< not since this start only: the source may have kept counting
};

} // namespace tappet
