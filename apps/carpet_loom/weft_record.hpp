// The record of a shift: arrival angles of the wefts and stops of the loom, for the weaver who sets it up.
#pragma once

#include "apps/carpet_loom/wires.hpp"
#include "kernel/component/component.hpp"

#include <algorithm>

namespace tappet::carpet {

/// A weft that the detector saw.
struct Arrival {
    std::int64_t pick = 0;
    double angle_deg = 0.0; ///< of the main shaft
};

/// Runs in a background activity. A buffer holds every arrival until it runs.
struct WeftRecord {
    BufferInput<Arrival> arrivals;
    Event<Duration> begun;
    Property<Duration> shift{8h};
    Output<std::int64_t> count;
    Output<double> earliest_deg;
    Output<double> mean_deg;
    Output<double> latest_deg;
    Output<double> stop_error_deg;

    void start(const Cycle& cycle) noexcept TAPPET_REALTIME {
        forget(cycle.now);
        begun.emit(shift.get());
    }
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        for (std::size_t i = 0; i < most_each_cycle; ++i) {
            Arrival arrival;
            if (!arrivals.pop(arrival)) return;
            add(arrival.angle_deg);
        }
    }
    /// Starts a new record, for instance with a new shift.
    void forget(Time) noexcept TAPPET_REALTIME {
        count.write(0);
        earliest_deg.write(0.0);
        mean_deg.write(0.0);
        latest_deg.write(0.0);
        stop_error_deg.write(0.0);
    }
    void on_stop(double error_deg) noexcept TAPPET_REALTIME { stop_error_deg.write(error_deg); }

    static constexpr auto interface() {
        return facets(
            input<&WeftRecord::arrivals>("arrivals", "", "every weft that arrived"),
            output<&WeftRecord::count>("count", "", "wefts in the record"),
            output<&WeftRecord::earliest_deg>("earliest_deg", "deg", "earliest arrival"),
            output<&WeftRecord::mean_deg>("mean_deg", "deg", "mean of the arrivals"),
            output<&WeftRecord::latest_deg>("latest_deg", "deg", "latest arrival"),
            output<&WeftRecord::stop_error_deg>("stop_error_deg", "deg", "of the last stop"),
            operation<&WeftRecord::on_stop>("on_stop", "the shaft stands; error in degrees", required),
            event<&WeftRecord::begun>("begun", "the first shift begins; its length", heard_by(1)),
            operation<&WeftRecord::forget>("forget", "begins the record anew", required),
            property<&WeftRecord::shift>("shift", "s", "length of a shift", range(60, 86400)));
    }

private:
    static constexpr std::size_t most_each_cycle = 64; // more than the buffer's row holds

    void add(double angle_deg) noexcept TAPPET_REALTIME {
        const std::int64_t n = count.last() + 1;
        earliest_deg.write(n == 1 ? angle_deg : std::min(earliest_deg.last(), angle_deg));
        latest_deg.write(n == 1 ? angle_deg : std::max(latest_deg.last(), angle_deg));
        mean_deg.write(mean_deg.last() + (angle_deg - mean_deg.last()) / static_cast<double>(n));
        count.write(n);
    }
};

} // namespace tappet::carpet
