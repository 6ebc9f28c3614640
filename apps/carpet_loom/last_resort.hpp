// What is left when the activity hangs that runs the states of the whole: brake, valve and drives are told
// without it.
#pragma once

#include "kernel/component/component.hpp"

namespace tappet::carpet {

/// Real-time, in the activity of the watchdogs.
struct LastResort {
    Event<> set_brake, close_valve, quick_stop;

    void act(Duration) noexcept TAPPET_REALTIME {
        set_brake.emit();
        close_valve.emit();
        quick_stop.emit();
    }

    static constexpr auto interface() {
        return facets(
            event<&LastResort::set_brake>("set_brake", "brake on", heard_by(1)),
            event<&LastResort::close_valve>("close_valve", "valve closed, and no weft let go", heard_by(2)),
            event<&LastResort::quick_stop>("quick_stop", "drives to a stand at once", heard_by(2)),
            operation<&LastResort::act>("act", "nobody else can: how long it was silent", required));
    }
};

} // namespace tappet::carpet
