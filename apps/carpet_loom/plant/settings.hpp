// The settings of a simulated loom beside weaving: random and scripted faults, and how its operator works.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/base/time.hpp"

#include <cstdint>

namespace tappet::loom {

enum class Fault : std::uint8_t {
    weft_break,     // the next weft does not arrive
    warp_break,     // a drop wire falls within the next turn
    node_lost,      // the CAN node `node` falls silent and, repaired, boots again
    drive_fault,    // the drive `node` (1 or 2) trips
    oil_lost,       // the oil pressure goes although the pump is on
    oil_level_low,  // the discrete input; it stops nothing by itself
    feeder_empty,   // the feeder's bobbin runs out
    emergency_stop, // the operator hits the emergency stop
    operator_stop,  // the operator presses stop
};

/// One scripted fault: at a time, or when a number of picks is reached, whichever comes first.
struct ScriptedFault {
    Fault fault = Fault::weft_break;
    Time at = never;
    std::uint64_t at_pick = ~std::uint64_t{0};
    Duration lasts{};      // 0: until the operator repairs it
    std::uint8_t node = 0; // node_lost, drive_fault
    bool operator==(const ScriptedFault&) const = default;
};

struct Settings {
    // Chances per pick: one in n on average, 0 = never.
    std::uint64_t weft_break_one_in = 0;
    std::uint64_t warp_break_one_in = 0;
    std::uint64_t operator_stop_one_in = 0;
    std::uint64_t emergency_stop_one_in = 0;
    Bounded<ScriptedFault, 32> script{};

    bool operator_present = true;
    Duration operator_reaction = 1s; // from standstill to the repair; acknowledge and start take a part of it
    std::uint64_t last_pick = 0; // the operator presses stop when it is reached and starts no more; 0 = never
    /// Ends only after a request, and at least so many picks after it; 0: no request is expected.
    std::uint64_t picks_after_told = 0;
    Duration edge_burst_at = Duration::max(); // the weft detector's line flutters then

    bool contact_bounce = true;         // of buttons and drop wires
    double brake_wear_per_stop = 0.001; // part of the torque lost by each stop, at most 0.15 in all
};

} // namespace tappet::loom
