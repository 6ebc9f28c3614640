// The last resort when an activity hangs. For the logic activity it sets brake, valve and drives directly;
// for the shaft activity it retracts the yarn cutter without waiting for a beat-up.
#pragma once

#include "kernel/component/component.hpp"

namespace tappet::carpet {

/// Real-time, in the activity of the watchdogs.
struct LastResort {
    Input<bool> logic_alive, shaft_alive;
    Event<> set_brake, close_valve, quick_stop, rest_cutter;

    /// Acts on watchdogs that are silent already: they report a silence once, perhaps to nobody.
    void start(const Cycle&) noexcept TAPPET_REALTIME {
        if (logic_alive.good() && !logic_alive.get()) act({});
        if (shaft_alive.good() && !shaft_alive.get()) let_cutter_rest({});
    }

    void act(Duration) noexcept TAPPET_REALTIME {
        set_brake.emit();
        close_valve.emit();
        quick_stop.emit();
    }
    void let_cutter_rest(Duration) noexcept TAPPET_REALTIME { rest_cutter.emit(); }

    static constexpr auto interface() {
        return facets(
            input<&LastResort::logic_alive>("logic_alive", "", "the activity of the states shows life"),
            input<&LastResort::shaft_alive>("shaft_alive", "", "the activity of the shaft shows life"),
            event<&LastResort::set_brake>("set_brake", "brake on", heard_by(1)),
            event<&LastResort::close_valve>("close_valve", "valve closed, and no weft let go", heard_by(2)),
            event<&LastResort::quick_stop>("quick_stop", "stop the drives at once", heard_by(2)),
            event<&LastResort::rest_cutter>("rest_cutter", "yarn cutter off", heard_by(1)),
            operation<&LastResort::let_cutter_rest>("let_cutter_rest", "the shaft is silent, for this time",
                                                    required),
            operation<&LastResort::act>(
                "act", "makes the machine safe when the logic hangs; silent for this time", required));
    }
};

} // namespace tappet::carpet
