// The verification model of the loom beside its table: the weft's release, the shaft's angles and its brake
// as a few variables, and the properties that must hold. See toolchain/tools/chart/model.hpp.
#pragma once

#include "apps/carpet_loom/machine.hpp"
#include "toolchain/tools/chart/model.hpp"

namespace tappet::carpet {

// The shed is open from the angle at which the valve takes effect until the arrival window has closed: the
// model has these two events for it.
static_assert(loom::wires::nominal::weft_release_deg >= loom::wires::nominal::shed_open_deg &&
                  loom::wires::nominal::weft_window_end_deg <= loom::wires::nominal::shed_closed_deg,
              "the weft's angles lie where the shed is open");

// clang-format off
inline constexpr auto model = chart::verification(
    // the weft: as in WeftInsertion
    chart::remembers("allowed", 0, 1),
    chart::remembers("ready", 0, 1),
    chart::remembers("released", 0, 1),
    chart::remembers("arrived", 0, 1),
    chart::remembers("early", 0, 1),
    // the shaft: the last angle event; its brake is 0 free, 1 wanted, 2 braking, 3 set by another component
    chart::remembers("angle", 0, 5),
    chart::remembers("brake", 0, 3),
    chart::remembers("by_operator", 0, 1), // the cause of the last stop

    chart::operation("weft.allow",   chart::sets("allowed = 1")),
    chart::operation("weft.hold",    chart::sets("allowed = 0; ready = 0")),
    chart::operation("weft.inhibit", chart::sets("allowed = 0; ready = 0"), chart::emits("weft.close_valve")),
    chart::operation("weft.lose_lines", chart::sets("allowed = 0; ready = 0"), chart::emits("weft.close_valve")),
    chart::operation("weft.on_beat_up", chart::sets("released = 0; arrived = 0; ready = allowed")),
    chart::operation("weft.on_release_angle", chart::when_true("ready && !released"), chart::sets("released = 1"),
                     chart::emits("weft.open_valve")),
    chart::operation("weft.on_close_angle",   chart::when_true("released"), chart::emits("weft.close_valve")),
    chart::operation("weft.on_window_opens",  chart::sets("early = arrived")),
    chart::operation("weft.on_window_closes", chart::when_true("released && (!arrived || early)"),
                     chart::emits("weft.missed")),
    chart::operation("weft.on_arrival", chart::sets("arrived = 1")),
    chart::operation("shaft.stop_at_angle", chart::when_true("brake == 0"), chart::sets("brake = 1")),
    chart::operation("shaft.release",       chart::sets("brake = 0")),
    chart::operation("shaft.brake_was_set", chart::sets("brake = 3")),

    // The angles come in their order. After a loss, the encoder restarts at any beat-up. The command "stop"
    // also brakes, so braking may come unrequested.
    chart::happens("shaft.beat_up",       chart::sets("angle = 0")),
    chart::happens("shaft.offer_pattern", chart::when_true("angle == 0"), chart::sets("angle = 1")),
    chart::happens("shaft.weft_opens",    chart::when_true("angle == 1"), chart::sets("angle = 2")),
    chart::happens("shaft.weft_closes",   chart::when_true("angle == 2"), chart::sets("angle = 3")),
    chart::happens("shaft.window_opens",  chart::when_true("angle == 3"), chart::sets("angle = 4")),
    chart::happens("shaft.window_closes", chart::when_true("angle == 4"), chart::sets("angle = 5")),
    chart::happens("shaft.brake_now",     chart::when_true("brake <= 1"), chart::sets("brake = 2")),
    chart::happens("shaft.stopped",       chart::when_true("brake >= 2"), chart::sets("brake = 0")),

    chart::program<&Loom::enter_locked>(chart::sets("by_operator = 0"),
                                        chart::emits("loom.disable_drives", "loom.inhibit_weft", "loom.quick_stop",
                                                     "loom.set_brake")),
    chart::program<&Loom::enter_preparing>(chart::sets("by_operator = 0"),
                                           chart::emits("loom.release_brake", "loom.enable_drives")),
    chart::program<&Loom::enter_run_up>(chart::sets("by_operator = 0"),
                                        chart::emits("loom.release_brake", "loom.allow_weft", "loom.run_shaft")),
    chart::program<&Loom::enter_emergency>(chart::sets("by_operator = 0"),
                                           chart::emits("loom.inhibit_weft", "loom.quick_stop", "loom.set_brake")),
    chart::program<&Loom::enter_fault>(chart::sets("by_operator = 0"),
                                       chart::emits("loom.inhibit_weft", "loom.quick_stop", "loom.set_brake")),
    chart::program<&Loom::enter_safe>(chart::emits("loom.disable_drives", "loom.inhibit_weft", "loom.quick_stop",
                                                   "loom.set_brake")),
    chart::program<&Loom::because_weft>(chart::sets("by_operator = 0")),
    chart::program<&Loom::because_warp>(chart::sets("by_operator = 0")),
    chart::program<&Loom::because_operator>(chart::sets("by_operator = 1")),
    chart::says<&Loom::operator_stopped>("by_operator"),

    chart::only_when("weft.open_valve", "angle >= 2 && angle <= 4", "no weft is released while the shed is closed"),
    chart::only_when("weft.open_valve", "brake <= 1", "no weft is released while the drive is stopping"),
    chart::always("!(in_loom_locked || in_loom_emergency || in_loom_fault || in_loom_safe) || !ready || !settled_shaft",
                  "in locked, emergency, fault and safe no weft is ready once the shaft's activity heard of it"));
// clang-format on

} // namespace tappet::carpet
