// What is left when an activity hangs: that of the states of the whole, and brake, valve and drives are told
// without it; that of the shaft, and the yarn cutter waits for no beat-up.
#pragma once

#include "kernel/component/component.hpp"

namespace tappet::carpet {

/// Real-time, in the activity of the watchdogs.
struct LastResort {
    Event<> set_brake, close_valve, quick_stop, rest_cutter;

    void act(Duration) noexcept TAPPET_REALTIME {
        set_brake.emit();
        close_valve.emit();
        quick_stop.emit();
    }
    void let_cutter_rest(Duration) noexcept TAPPET_REALTIME { rest_cutter.emit(); }

    static constexpr auto interface() {
        return facets(
            event<&LastResort::set_brake>("set_brake", "brake on", heard_by(1)),
            event<&LastResort::close_valve>("close_valve", "valve closed, and no weft let go", heard_by(2)),
            event<&LastResort::quick_stop>("quick_stop", "drives to a stand at once", heard_by(2)),
            event<&LastResort::rest_cutter>("rest_cutter", "yarn cutter off", heard_by(1)),
            operation<&LastResort::let_cutter_rest>("let_cutter_rest", "the shaft is silent: for how long",
                                                    required),
            operation<&LastResort::act>("act", "nobody else can: how long it was silent", required));
    }
};

} // namespace tappet::carpet
