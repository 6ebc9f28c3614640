// The states of the car tracker (thesis fig. 5.24), with the localisation program of fig. 5.23 inside the
// last one.
#pragma once

#include "apps/car_tracking/tracking.hpp"
#include "kernel/statechart/rows.hpp"

namespace tappet::car_tracking {

// clang-format off
inline constexpr auto tracking_cycle = state_machine<Tracking>("tracking_cycle",
    states(
        state("Startup", initial, entry<&Tracking::switch_on>),
        state("Waiting"),
        state("Positioning", entry<&Tracking::go_there>),
        state("Calibration", entry<&Tracking::begin_calibration>),
        state("ReadyForLocalisation"),
        state("LocaliseCar"),
        state("Fetching", in("LocaliseCar"), initial, entry<&Tracking::fetch>),
        state("Processing", in("LocaliseCar"), entry<&Tracking::process>),
        state("Following", in("LocaliseCar"), entry<&Tracking::follow>),
        state("Shutdown", final, entry<&Tracking::switch_off>)),
    transitions(
        transition("Startup", "Waiting"),
        transition("Waiting", "Calibration", on("panel.start_calibration")),
        transition("Waiting", "Positioning", on("wanted_elsewhere")),
        transition("Positioning", "Waiting", guard<&Tracking::moved>),
        transition("Calibration", "ReadyForLocalisation", guard<&Tracking::calibrated>),
        transition("Calibration", "Waiting", guard<&Tracking::calibration_ended>),
        transition("ReadyForLocalisation", "LocaliseCar", on("panel.start_localisation"), then<&Tracking::begin_localising>),
        internal("LocaliseCar", on("panel.stop_localisation"), then<&Tracking::ask_to_stop>),
        transition("Fetching", "Processing", guard<&Tracking::fetched>),
        transition("Processing", "Fetching", guard<&Tracking::processed_without_car>, then<&Tracking::count_miss>),
        transition("Processing", "Following", guard<&Tracking::processed>),
        transition("Following", "ReadyForLocalisation", guard<&Tracking::stops_after_move>),
        transition("Following", "Fetching", guard<&Tracking::moved>)));
// clang-format on

} // namespace tappet::car_tracking
