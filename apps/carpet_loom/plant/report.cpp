// The histogram's arithmetic and the report as JSON text.
#include "apps/carpet_loom/plant/report.hpp"

namespace tappet::loom {

const char* name_of(StopCause cause) noexcept TAPPET_REALTIME {
    switch (cause) {
    case StopCause::emergency: return "emergency";
    case StopCause::fault: return "fault";
    case StopCause::warp: return "warp";
    case StopCause::weft: return "weft";
    case StopCause::operator_stop: return "operator";
    case StopCause::machine: return "machine";
    }
    return "unknown";
}

void ErrorHistogram::add(double error_deg) noexcept TAPPET_REALTIME {
    const double size = error_deg < 0.0 ? -error_deg : error_deg;
    const auto bin = static_cast<std::size_t>(size / bin_deg);
    ++bins_[bin < bins_.size() ? bin : bins_.size() - 1];
    ++samples_;
    if (size > max_deg_) max_deg_ = size;
}

double ErrorHistogram::percentile_deg(unsigned percent) const noexcept TAPPET_REALTIME {
    const std::uint64_t wanted = (samples_ * percent + 99) / 100;
    std::uint64_t seen = 0;
    for (std::size_t bin = 0; bin < bins_.size(); ++bin) {
        seen += bins_[bin];
        const double upper = static_cast<double>(bin + 1) * bin_deg;
        if (seen >= wanted && seen > 0) return upper < max_deg_ ? upper : max_deg_;
    }
    return max_deg_;
}

namespace {

template <class List, class Write>
void write_list(JsonText& json, std::string_view name, const List& list, const Write& write) {
    json.key(name).open('[');
    for (const auto& each : list) {
        json.open('{');
        write(each);
        json.close('}');
    }
    json.close(']');
}

void write_damage(JsonText& json, const Damage& damage) {
    json.key("damage")
        .open('{')
        .field("total", damage.total())
        .field("closed_shed_wefts", damage.closed_shed_wefts)
        .field("double_wefts", damage.double_wefts)
        .field("late_wefts", damage.late_wefts)
        .field("valve_after_emergency", damage.valve_after_emergency)
        .field("tension_high", damage.tension_high)
        .field("tension_low", damage.tension_low)
        .field("moved_unpowered", damage.moved_unpowered)
        .field("motor_blocked", damage.motor_blocked)
        .field("ran_dry", damage.ran_dry)
        .close('}');
}

} // namespace

void write_json(const Report& report, JsonText& json) {
    json.field("seed", report.seed)
        .field("time_s", report.time_s)
        .field("running_s", report.running_s)
        .field("picks", report.picks)
        .field("picks_by_hand", report.picks_by_hand)
        .field("empty_turns", report.empty_turns)
        .field("picks_per_minute", report.picks_per_minute)
        .field("weft_breaks_injected", report.weft_breaks_injected)
        .field("warp_breaks_injected", report.warp_breaks_injected)
        .field("patterns_repeated", report.patterns_repeated);
    write_list(json, "patterns", report.patterns, [&json](const LiftedPattern& each) {
        json.field("pattern", each.pattern)
            .field("picks", each.picks)
            .field("first_at_pick", each.first_at_pick);
    });
    json.field("yarn_cuts", report.yarn_cuts).field("stops_total", report.stops_total);
    write_list(json, "stops", report.stops, [&json](const Stop& stop) {
        json.field("cause", name_of(stop.cause))
            .field("angle_deg", stop.angle_deg)
            .field("error_deg", stop.error_deg)
            .field("distance_deg", stop.distance_deg)
            .field("at_pick", stop.at_pick)
            .field("at_s", static_cast<double>(stop.at_ns) * 1e-9);
    });
    json.key("cam_error_deg")
        .open('{')
        .field("samples", report.cam_samples)
        .field("p50", report.cam_error_p50_deg)
        .field("p99", report.cam_error_p99_deg)
        .field("max", report.cam_error_max_deg)
        .close('}');
    json.field("emergency_stops", report.emergency_stops)
        .field("emergency_longest_ms", report.emergency_longest_ms)
        .field("tension_least_n", report.tension_least_n)
        .field("tension_most_n", report.tension_most_n)
        .field("weaving_s", report.weaving_s)
        .field("tension_out_of_band_s", report.tension_out_of_band_s)
        .field("drive_faults", report.drive_faults)
        .field("frames_lost", report.frames_lost)
        .field("edges_lost", report.edges_lost);
    write_damage(json, report.damage);
    char digits[16];
    const auto end = std::to_chars(digits, digits + sizeof digits, report.digest, 16).ptr;
    json.field("digest", std::string_view{digits, end});
}

} // namespace tappet::loom
