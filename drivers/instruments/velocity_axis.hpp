// An axis with a drive that takes velocities: only what it may do goes to the wire.
#pragma once

#include "kernel/base/number.hpp"
#include "kernel/base/text.hpp"
#include "kernel/component/component.hpp"

#include <algorithm>

namespace tappet::instruments {

/// Effector of a velocity: VelocityAxis<"m/s">. Within `most` either way; what is no number is none, and
/// neither is what a force hid when its writer stopped.
/// Controllers read what was sent from `velocity`. Real-time.
template <text unit>
struct VelocityAxis {
    Input<double> wanted;
    Output<double> velocity;
    Property<double> most{0.0};

    void start(const Cycle& cycle) noexcept TAPPET_REALTIME { stop(cycle); }
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        const double now = wanted.get();
        const bool is_wanted = is_number(now) && !wanted.is_abandoned();
        velocity.write(is_wanted ? std::clamp(now, -most.get(), most.get()) : 0.0);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { velocity.write(0.0); }

    static constexpr auto interface() {
        return facets(input<&VelocityAxis::wanted>("wanted", unit.view(), "of the drive"),
                      output<&VelocityAxis::velocity>("velocity", unit.view(), "sent, within the limit"),
                      property<&VelocityAxis::most>("most", unit.view(), "either way; 0: it never moves",
                                                    range(0.0, 1e9)));
    }
};

} // namespace tappet::instruments
