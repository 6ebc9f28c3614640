// The summary of a run: what the machine counted and what the plant measured at the true shaft, as one JSON
// object.
#pragma once

#include "kernel/machine/instance/instance.hpp"

#include <cstdint>
#include <span>
#include <string_view>

namespace tappet::carpet {

/// What only the one who ran the machine knows.
struct RunFacts {
    std::string_view world;
    bool realtime = false;
    std::uint64_t seed = 0;
    std::uint64_t page_faults_after_arming = 0;
    std::uint64_t can_frames_lost = 0;
    std::uint64_t gpio_edges_lost = 0;
    std::uint64_t modbus_outages_survived = 0;
    /// What came on the wires and was not as it must be.
    struct {
        std::uint64_t can_faults = 0;
        std::uint64_t can_restarts = 0;
        std::uint64_t can_wrong_lengths = 0;
        std::uint64_t can_impostors = 0;
        std::uint64_t can_malformed = 0;
    } wires;
    std::string_view stop_reason;
    std::uint64_t contracts_broken = 0;
    Duration start_to_armed{}; ///< from the loading of the program; zero where nothing is armed
    bool with_digest = false;  ///< virtual time only: elsewhere no two runs are alike
};

/// The machine's half: an object without its closing brace, so that the plant's half can follow. Not
/// real-time. The number of characters; 0 when the buffer is too small.
[[nodiscard]] std::size_t write_machine_summary(const MachineInstance& instance, const RunFacts& facts,
                                                std::span<char> buffer);

} // namespace tappet::carpet
