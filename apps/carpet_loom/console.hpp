// The loom's console: shows the machine's status on the box's terminal, one line at a time. The demo
// parses these lines.
#pragma once

#include "apps/carpet_loom/loom_state.hpp"
#include "drivers/can/frame.hpp"
#include "kernel/component/component.hpp"
#include "kernel/os/terminal.hpp"

namespace tappet::carpet {

/// Runs in a background activity. Its lines begin with "loom ", so that another program can pick them out of
/// a serial console. Lines that nobody reads in time are dropped.
struct Console {
    Input<LoomState> state;
    Input<StopCause> cause;
    Input<WaitsFor> waits_for;
    Input<std::int64_t> stops, picks, frames_lost, bus_state, bus_restarts, edges_lost, outages;
    Input<double> speed_rpm, angle_deg, stop_error_deg, tension_n, oil_bar;
    Property<bool> quiet{false};

    void work(const Cycle& cycle) {
        if (quiet.get()) return;
        Sentence line{"loom t=",
                      to_ns(cycle.now) / 1'000'000,
                      "ms state=",
                      name_of(state.get()),
                      " speed=",
                      whole(speed_rpm.get()),
                      "rpm angle=",
                      whole(angle_deg.get()),
                      "deg picks=",
                      picks.get(),
                      " tension=",
                      whole(tension_n.get()),
                      "N oil=",
                      whole(oil_bar.get() * 100.0),
                      "cbar stops=",
                      stops.get(),
                      " cause=",
                      name_of(cause.get()),
                      " stop_error=",
                      whole(stop_error_deg.get() * 10.0),
                      "ddeg bus=",
                      to_text(static_cast<can::State>(bus_state.get())),
                      " frames_lost=",
                      frames_lost.get(),
                      " edges_lost=",
                      edges_lost.get(),
                      " outages=",
                      outages.get(),
                      " restarts=",
                      bus_restarts.get(),
                      " waits_for=",
                      name_of(waits_for.get()),
                      "\n"};
        os::print(line.view());
    }

    static constexpr auto interface() {
        return facets(
            input<&Console::state>("state", "", "of the loom"),
            input<&Console::cause>("cause", "", "of the last stop"),
            input<&Console::waits_for>("waits_for", "", "what is missing before the loom may start"),
            input<&Console::stops>("stops", "", "at the stop angle"),
            input<&Console::picks>("picks", "", "woven"),
            input<&Console::frames_lost>("frames_lost", "", "on the CAN bus"),
            input<&Console::bus_state>("bus_state", "", "of the CAN bus"),
            input<&Console::bus_restarts>("bus_restarts", "", "of the CAN bus, since start"),
            input<&Console::edges_lost>("edges_lost", "", "on the GPIO lines"),
            input<&Console::outages>("outages", "", "of the utility unit"),
            input<&Console::speed_rpm>("speed_rpm", "rpm", "of the main shaft"),
            input<&Console::angle_deg>("angle_deg", "deg", "of the main shaft"),
            input<&Console::stop_error_deg>("stop_error_deg", "deg", "of the last stop"),
            input<&Console::tension_n>("tension_n", "N", "of the warp"),
            input<&Console::oil_bar>("oil_bar", "bar", "oil pressure"),
            property<&Console::quiet>("quiet", "", "print nothing"));
    }

private:
    static std::int64_t whole(double value) {
        return static_cast<std::int64_t>(value + (value < 0.0 ? -0.5 : 0.5));
    }
};

} // namespace tappet::carpet
