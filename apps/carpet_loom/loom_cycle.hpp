// The state machine of the carpet loom.
#pragma once

#include "apps/carpet_loom/loom.hpp"
#include "kernel/statechart/rows.hpp"

namespace tappet::carpet {

inline constexpr std::string_view unprepared = "the loom is not prepared; it waits for";
inline constexpr std::string_view unsafe = "the brake may not be released; the loom waits for";

// clang-format off
inline constexpr auto loom_cycle = state_machine<Loom>("loom_cycle",
    states(
        state("locked",    initial, entry<&Loom::enter_locked>),                     // nothing moves: acknowledge
        state("operating"),
        state("preparing", in("operating"), initial, entry<&Loom::enter_preparing>), // drives on, tension, oil
        state("asking",    in("operating"), entry<&Loom::enter_asking>),             // as preparing, but waits for an acknowledgement
        state("ready",     in("operating"), entry<&Loom::enter_ready>),              // the operator may start
        state("running",   in("operating")),
        state("run_up",    in("running"), initial, entry<&Loom::enter_run_up>),
        state("weave",     in("running"), entry<&Loom::enter_weave>),
        state("stopping",  in("operating"), entry<&Loom::enter_stopping>),           // to the stop angle
        state("stopped",   in("operating"), entry<&Loom::enter_stopped>),            // waits for repair
        state("emergency", entry<&Loom::enter_emergency>),
        state("fault",     entry<&Loom::enter_fault>),
        state("safe",      final, entry<&Loom::enter_safe>)),
    transitions(
        transition("locked",    "preparing", on("io.button_acknowledge.rises"), guard<&Loom::may_prepare>.because<&Loom::obstacle>(unsafe)),
        transition("preparing", "ready",     guard<&Loom::prepared>.because<&Loom::missing>(unprepared)),
        transition("preparing", "preparing", on("io.button_acknowledge.rises"), guard<&Loom::may_prepare>.because<&Loom::obstacle>(unsafe)), // enables the drives again
        transition("preparing", "asking",    after(2s), guard<&Loom::drives_are_off>, because("a drive was asked to follow and does not: acknowledge, and it is asked again")),
        transition("asking",    "ready",     guard<&Loom::prepared>.because<&Loom::missing>(unprepared)),
        transition("asking",    "preparing", on("io.button_acknowledge.rises"), guard<&Loom::may_prepare>.because<&Loom::obstacle>(unsafe)),
        transition("ready",     "run_up",    on("io.button_start.rises"), guard<&Loom::may_start>.because<&Loom::missing>(unprepared)),
        transition("run_up",    "weave",     guard<&Loom::at_speed>.because("the shaft has not reached its speed yet")),
        transition("run_up",    "fault",     after(3s), because("the shaft did not reach its speed within 3 s")),
        transition("running",   "stopping",  on("weft.missed"), then<&Loom::because_weft>, because("the weft did not arrive")),
        transition("running",   "stopping",  on("io.drop_wire.rises"), then<&Loom::because_warp>, because("a warp end broke")),
        transition("running",   "stopping",  on("io.button_stop.rises"), then<&Loom::because_operator>, because("the operator pressed stop")),
        transition("running",   "ready",     on("shaft.stopped"), then<&Loom::because_operator>, because("the shaft was stopped from the box")),
        transition("running",   "fault",     guard<&Loom::oil_is_lost>, because("the oil pressure is lost")),
        transition("running",   "fault",     guard<&Loom::node_is_silent>, because("a CAN node is silent")),
        transition("running",   "fault",     guard<&Loom::encoder_is_stale>, because("the encoder is stale")),
        transition("running",   "fault",     guard<&Loom::drive_slips>, because("the main drive does not keep its speed")),
        transition("running",   "fault",     on("shaft_dog.silent"), because("the shaft's activity shows no life")),
        transition("weave",     "fault",     guard<&Loom::encoder_stands>, because("the encoder stands while the drive turns")),
        transition("stopping",  "ready",     on("shaft.stopped"), guard<&Loom::operator_stopped>),
        transition("stopping",  "stopped",   on("shaft.stopped")),
        transition("stopping",  "fault",     guard<&Loom::stop_is_refused>, because("the shaft does not take the stop")),
        transition("stopping",  "fault",     after(3s), because("the shaft did not stop within 3 s")),
        transition("stopping",  "fault",     guard<&Loom::encoder_is_stale>, because("the encoder is stale")),
        transition("stopping",  "fault",     on("shaft_dog.silent"), because("the shaft's activity shows no life")),
        transition("stopped",   "preparing", on("io.button_acknowledge.rises"), guard<&Loom::repaired>.because<&Loom::missing>("the loom stands; it waits for")),
        transition("operating", "emergency", on("io.emergency_stop.rises"), because("the emergency stop was pressed")),
        transition("operating", "emergency", guard<&Loom::emergency_is_pressed>, because("the emergency stop is pressed")),
        transition("operating", "emergency", on("io.line_fault"), because("the lines can no longer be relied on")),
        transition("operating", "emergency", on("io_dog.silent"), because("the lines' activity shows no life")),
        transition("operating", "fault",     on("motion_dog.silent"), because("the motion activity shows no life")),
        transition("operating", "fault",     guard<&Loom::bus_is_off>, because("the CAN bus is off")),
        transition("running",   "fault",     guard<&Loom::drive_is_faulty>, because("a drive reports a fault")),
        transition("operating", "fault",     guard<&Loom::something_is_lost>, because("a node, a drive or the encoder was lost")),
        transition("emergency", "preparing", on("io.button_acknowledge.rises"), guard<&Loom::may_prepare>.because<&Loom::obstacle>(unsafe)),
        transition("fault",     "preparing", on("io.button_acknowledge.rises"), guard<&Loom::may_prepare>.because<&Loom::obstacle>(unsafe))));
// clang-format on

} // namespace tappet::carpet
