// State machines and their connections in a machine table, as a Promela model that spin searches.
//
// Order and atomicity are those of an engine's step (kernel/activity/engine.cpp): an activity's own events
// first, then every message that waits for it; a state machine runs until it waits. Messages of one sender
// keep their order. Time is not modelled: a time-out may come at any time after its state was entered, and a
// step may be arbitrarily late. Anything unknown to a model may be true or false.
//
// Compiled with REQUESTS, the model also requests the final and the initial state at any time. With FAILURES,
// any action may fail. With STOP, the world becomes silent once and every machine gets a request for its
// final state: each run must then end there.
#pragma once

#include "kernel/machine/table/machine.hpp"
#include "toolchain/tools/chart/chart.hpp"
#include "toolchain/tools/chart/model.hpp"

#include <span>
#include <string>
#include <vector>

namespace tappet::chart {

struct Composition {
    std::vector<Chart> charts;
    MachineView machine{};             ///< its reactions and activities; empty: one machine in a free world
    std::span<const ModelRow> model{}; ///< empty: everything beside the tables is free
};

struct PromelaModel {
    std::string text;  ///< empty when there is a fault
    std::string fault; ///< what, where and the cure
};

/// Models one state machine alone: its events come whenever its active states hear them.
PromelaModel to_promela(const Chart& chart);
/// Models several, the reactions between their components, and the rows of a verification.
PromelaModel to_promela(const Composition& composition);

/// The state machines of a table, including scripts' instances; slots are empty until something is loaded.
std::vector<Chart> charts_of(const MachineView& machine);
/// Returns those of one script, on the component that it drives.
std::vector<Chart> charts_of(const ScriptUnit& unit, std::string_view component);

} // namespace tappet::chart
