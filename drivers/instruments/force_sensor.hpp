// A force sensor of one axis: what it shows with nothing on it is taken off, and an overload is told.
#pragma once

#include "kernel/base/number.hpp"
#include "kernel/component/component.hpp"

#include <cmath>

namespace tappet::instruments {

/// Sensor of a force, N. While what is measured is stale, or is no number, with the tare or without it, the
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
    /// Others are not to push on with a force that nobody measures.
    void stop(const Cycle&) noexcept TAPPET_REALTIME { force.write(0.0); }
    /// What lies on it now is no load.
    void tare() noexcept TAPPET_REALTIME {
        if (good.last()) tare_ = measured_;
    }

    static constexpr auto interface() {
        return facets(
            input<&ForceSensor::measured>("measured", "N", "by the cell"),
            output<&ForceSensor::force>("force", "N", "without the tare"),
            output<&ForceSensor::good>("good", "", "the force is that of now", while_stopped(false)),
            event<&ForceSensor::overloaded>("overloaded", "N: it is above the cell's range"),
            property<&ForceSensor::most>("most", "N", "that the cell bears, tare included", range(0.0, 1e9)),
            operation<&ForceSensor::tare>("tare", "what lies on it now is no load"));
    }

private:
    double tare_ = 0.0, measured_ = 0.0;
    bool is_overloaded_ = false;
};

} // namespace tappet::instruments
