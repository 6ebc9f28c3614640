// Totals that survive the main switch: components whose total is a property that a file keeps.
//     component<HourMeter>("spindle_hours", properties_file("spindle_hours.cpf", optional))
//     component<Total>("pieces", properties_file("pieces.cpf", optional))
//     component<PropertyKeeper>("keeper", set("every", 60s))   // what a sudden end may cost at most
// Files are written at an orderly halt, when somebody asks for it, and as often as a keeper says.
#pragma once

#include "kernel/component/component.hpp"

#include <algorithm>
#include <limits>

namespace tappet {

/// How long something has been running. Real-time, in a periodic activity.
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
    static constexpr Duration most = 9'000'000'000s; ///< that a Duration holds, in round figures
    Time last_ = never;
};

/// Adds up a count that begins anew at each start of who counts: pieces, strokes, stops. What is counted
/// while this component stands it adds when it runs again. What the count is forced to is counted. Real-time.
struct Total {
    Input<std::int64_t> count;
    Output<std::int64_t> sum;
    Property<std::int64_t> total{0};

    void start(const Cycle&) noexcept TAPPET_REALTIME { sum.write(total.get()); }
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        std::int64_t now = 0;
        if (count.read(now) != Flow::fresh) return;
        std::int64_t more = 0, all = 0;
        if (now < counted_ || __builtin_sub_overflow(now, counted_, &more)) more = now; // it began anew
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
    std::int64_t counted_ = 0; ///< not of this start alone: the other may have gone on
};

} // namespace tappet
