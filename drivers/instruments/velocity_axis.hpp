// An axis with a drive that takes velocities: limits the velocity that is sent.
#pragma once

#include "kernel/base/number.hpp"
#include "kernel/base/text.hpp"
#include "kernel/component/component.hpp"

#include <algorithm>

namespace tappet::instruments {

/// Effector of a velocity: VelocityAxis<"m/s">. Limits it to `most` in both directions. Sends 0 in place of a
/// value that is not a number, or that a force hid while its writer stopped. Controllers read the sent value
/// from `velocity`. Real-time.
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
                      property<&VelocityAxis::most>("most", unit.view(),
                                                    "limit in both directions; 0: it never moves",
                                                    range(0.0, 1e9)));
    }
};

} // namespace tappet::instruments
