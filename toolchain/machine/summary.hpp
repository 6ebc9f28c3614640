// The summary of a run: the machine's counters and measurements, as one JSON object.
#pragma once

#include "drivers/hardware/devices.hpp"
#include "kernel/machine/instance/instance.hpp"

#include <cstdint>
#include <span>
#include <string_view>

namespace tappet {

/// The facts that only the runner of the machine knows.
struct RunFacts {
    bool realtime = false;
    std::uint64_t seed = 0;
    std::uint64_t page_faults_after_arming = 0;
    WireCounters wires{};
    Sentence stop_reason{};
    std::uint64_t contracts_broken = 0;
    Duration start_to_armed{}; ///< from the loading of the program; zero when nothing is armed
    bool with_digest = false;  ///< virtual time only: other runs are never identical
};

/// Writes an object without its closing brace, so that more fields can follow. Returns the number of
/// characters; 0 when the buffer is too small. Not real-time.
[[nodiscard]] std::size_t write_summary(MachineInstance& instance, const RunFacts& facts,
                                        std::span<char> buffer);

/// Prints the findings of a run at its end, line by line: exceeded budgets, behaviours that did not complete,
/// frames that took longer than proven, missed deadlines and their activities.
void tell_overruns(MachineInstance& instance, std::string_view speaker);

} // namespace tappet
