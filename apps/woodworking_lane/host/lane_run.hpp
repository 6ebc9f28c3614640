// All five machines of the lane and their hall in one process, under virtual time.
#pragma once

#include "apps/woodworking_lane/plant.hpp"
#include "toolchain/machine/system_run.hpp"

namespace woodworking {

inline constexpr std::size_t node_count = 5; ///< the conveyor, then the stations

/// Returns the accepted machines of all nodes, for the host. Once per process: their memory is static.
[[nodiscard]] std::array<AcceptedMachine, node_count> machines();
[[nodiscard]] const SystemView& lane_view();

/// The state of everything at an instant, for judges and pictures.
struct Moment {
    double at_s = 0;
    double gone = 0, speed = 0;
    std::array<bool, station_count> tools{};
    std::array<bool, node_count> alive{};
};

class LaneRun {
public:
    explicit LaneRun(std::uint64_t seed, int boards = 12);

    Hall hall;
    ConveyorPlant conveyor{hall};
    std::array<StationPlant, station_count> stations{StationPlant{hall, 0}, StationPlant{hall, 1},
                                                     StationPlant{hall, 2}, StationPlant{hall, 3}};
    SystemRun system;
    std::vector<Moment> moments{};

    std::expected<void, Sentence> start();
    /// Presses acknowledge once at the conveyor.
    void acknowledge();
    /// Runs until all boards have left; returns false when they have not within `limit`.
    bool run_through(Duration limit);
    /// Runs, and records the state every 20 ms.
    bool run_for(Duration time);
    void kill(std::size_t node) {
        system.kill(node);
        if (node > 0) hall.tools[node - 1] = false; // as its guardian does
    }

private:
    [[nodiscard]] std::array<Plant*, node_count> plants() {
        return {&conveyor, &stations[0], &stations[1], &stations[2], &stations[3]};
    }
};

/// Returns what was wrong with the boards' work; empty: nothing. Counts missed boards in `missed`.
[[nodiscard]] Sentence fault_of(const Hall& hall, int& missed);

/// Returns the boards over time, as an SVG document.
[[nodiscard]] std::string picture_of(const LaneRun& run);

} // namespace woodworking
