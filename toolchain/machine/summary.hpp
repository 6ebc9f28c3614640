// The summary of a run: what a machine counted and measured, as one JSON object.
#pragma once

#include "drivers/hardware/devices.hpp"
#include "kernel/machine/instance/instance.hpp"

#include <cstdint>
#include <span>
#include <string_view>

namespace tappet {

/// What only the one who ran the machine knows.
struct RunFacts {
    bool realtime = false;
    std::uint64_t seed = 0;
    std::uint64_t page_faults_after_arming = 0;
    WireCounters wires{};
    Sentence stop_reason{};
    std::uint64_t contracts_broken = 0;
    Duration start_to_armed{}; ///< from the loading of the program; zero where nothing is armed
    bool with_digest = false;  ///< virtual time only: elsewhere no two runs are alike
};

/// An object without its closing brace, so that more fields can follow. Not real-time. The number of
/// characters; 0 when the buffer is too small.
[[nodiscard]] std::size_t write_summary(MachineInstance& instance, const RunFacts& facts,
                                        std::span<char> buffer);

/// What a run should be told of at its end, line by line: budgets that were exceeded, behaviours that did not
/// come to their end, frames that took longer than was proven, deadlines that were missed and by whom.
void tell_overruns(MachineInstance& instance, std::string_view speaker);

} // namespace tappet
