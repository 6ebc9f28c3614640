// A force sensor of one axis: subtracts the tare, and reports an overload.
#pragma once

#include "kernel/base/number.hpp"
#include "kernel/component/component.hpp"

#include <cmath>

namespace tappet::instruments {

/// Sensor of a force, N. While the measured value is stale or not a number, with or without the tare, the
/// last force stays and `good` is false. Real-time.
struct ForceSensor {
    Input<double> measured;
    Output<double> force;
    Output<bool> good;
    Event<double> overloaded;
    Property<double> most{1e6};

    void start(const Cycle& cycle) noexcept TAPPET_REALTIME {
        is_overloaded_ = false;
        step(cycle);
    }
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        double now = 0.0;
        const Flow flow = measured.read(now);
        const bool is_measured = (flow == Flow::fresh || flow == Flow::old) && is_number(now);
        const bool is_good = is_measured && is_number(now - tare_);
        if (is_good) force.write((measured_ = now) - tare_, measured.stamp());
        good.write(is_good);
        const bool too_much = is_measured && std::abs(now) > most.get();
        if (too_much && !is_overloaded_) overloaded.emit(now);
        is_overloaded_ = too_much;
    }
    /// Writes 0 N, so that no controller continues to act on a force that is no longer measured.
    void stop(const Cycle&) noexcept TAPPET_REALTIME { force.write(0.0); }
    /// Takes the present force as zero load.
    void tare() noexcept TAPPET_REALTIME {
        if (good.last()) tare_ = measured_;
    }

    static constexpr auto interface() {
        return facets(input<&ForceSensor::measured>("measured", "N", "by the cell"),
                      output<&ForceSensor::force>("force", "N", "without the tare"),
                      output<&ForceSensor::good>("good", "", "the force is current", while_stopped(false)),
                      event<&ForceSensor::overloaded>("overloaded", "N: it is above the cell's range"),
                      property<&ForceSensor::most>(
                          "most", "N", "largest force that the cell bears, tare included", range(0.0, 1e9)),
                      operation<&ForceSensor::tare>("tare", "takes the present load as zero"));
    }

private:
    double tare_ = 0.0, measured_ = 0.0;
    bool is_overloaded_ = false;
};

} // namespace tappet::instruments
