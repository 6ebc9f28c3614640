// The plant's measurements at the true shaft: the reference for the machine's own figures.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/base/realtime.hpp"
#include "kernel/services/json.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace tappet::loom {

enum class StopCause : std::uint8_t {
    emergency,
    fault,
    warp,
    weft,
    operator_stop,
    machine, // the machine stopped, and the plant knows no cause
};
[[nodiscard]] const char* name_of(StopCause cause) noexcept TAPPET_REALTIME;

struct Stop {
    StopCause cause = StopCause::machine;
    std::int64_t at_ns = 0;
    std::uint64_t at_pick = 0;
    double angle_deg = 0.0;    // true shaft at standstill
    double error_deg = 0.0;    // to wires::nominal::stop_deg, positive: too far
    double distance_deg = 0.0; // from the brake line's edge to standstill; 0 when the brake was not used
    bool operator==(const Stop&) const = default;
};

/// One pattern to which the harnesses were lifted.
struct LiftedPattern {
    std::uint16_t pattern = 0;
    std::uint64_t picks = 0;
    std::uint64_t first_at_pick = 0; // picks woven before
};

/// Histogram of error sizes in bins of 0.01 degree up to 20 degrees; larger errors count in the maximum only.
class ErrorHistogram {
public:
    void add(double error_deg) noexcept TAPPET_REALTIME;
    [[nodiscard]] std::uint64_t samples() const noexcept TAPPET_REALTIME { return samples_; }
    [[nodiscard]] double max_deg() const noexcept TAPPET_REALTIME { return max_deg_; }
    /// Returns the size that `percent` of 100 errors do not exceed; 0 without samples.
    [[nodiscard]] double percentile_deg(unsigned percent) const noexcept TAPPET_REALTIME;

private:
    static constexpr double bin_deg = 0.01;
    std::array<std::uint32_t, 2000> bins_{};
    std::uint64_t samples_ = 0;
    double max_deg_ = 0.0;
};

/// Damage: what a machine must never do to its loom.
struct Damage {
    std::uint64_t closed_shed_wefts = 0;     // released outside the open shed
    std::uint64_t double_wefts = 0;          // a second weft in one shed
    std::uint64_t late_wefts = 0;            // caught by the closing shed
    std::uint64_t valve_after_emergency = 0; // the release valve driven while the emergency stop was pressed
    std::uint64_t tension_high = 0;
    std::uint64_t tension_low = 0;
    std::uint64_t moved_unpowered = 0; // the shaft turned with the drive not enabled and the brake off
    std::uint64_t motor_blocked = 0;   // the motor driven against the brake until it tripped
    std::uint64_t ran_dry = 0;         // run for long without oil pressure
    [[nodiscard]] std::uint64_t total() const noexcept TAPPET_REALTIME {
        return closed_shed_wefts + double_wefts + late_wefts + valve_after_emergency + tension_high +
               tension_low + moved_unpowered + motor_blocked + ran_dry;
    }
};

struct Report {
    static constexpr std::size_t most_stops = 256;
    static constexpr std::size_t most_patterns = 16;

    std::uint64_t seed = 0;
    double time_s = 0.0;
    double running_s = 0.0; // the shaft turned
    std::uint64_t picks = 0;
    std::uint64_t picks_by_hand = 0; // the operator laid the missing weft
    std::uint64_t empty_turns = 0;   // beaten up without a weft
    double picks_per_minute = 0.0;   // of running time
    std::uint64_t weft_breaks_injected = 0;
    std::uint64_t warp_breaks_injected = 0;
    std::uint64_t patterns_repeated = 0; // the dobby was offered no new pick
    Bounded<LiftedPattern, most_patterns>
        patterns{}; // in the order of their first picks; those that found room
    std::uint64_t yarn_cuts = 0;
    std::uint64_t stops_total = 0;
    Bounded<Stop, most_stops> stops{}; // the first ones
    std::uint64_t cam_samples = 0;     // true angle of the release's effect against weft_release_deg
    double cam_error_p50_deg = 0.0;
    double cam_error_p99_deg = 0.0;
    double cam_error_max_deg = 0.0;
    std::uint64_t emergency_stops = 0;
    double emergency_longest_ms = 0.0; // from the line's edge to standstill
    double tension_least_n = 0.0;      // while weaving at speed
    double tension_most_n = 0.0;
    double weaving_s = 0.0; // at speed
    double tension_out_of_band_s = 0.0;
    std::uint64_t drive_faults = 0;
    std::uint64_t frames_lost = 0; // nobody fetched them
    std::uint64_t edges_lost = 0;
    Damage damage{};
    std::uint64_t digest = 0;
};

/// Writes the report as fields of an open object.
void write_json(const Report& report, JsonText& json);

} // namespace tappet::loom
