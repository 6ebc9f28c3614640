// The histogram's arithmetic and the report as JSON text.
#include "apps/carpet_loom/plant/report.hpp"

#include "apps/carpet_loom/plant/shapes.hpp"

#include <charconv>
#include <string_view>

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

class JsonWriter {
public:
    explicit JsonWriter(std::span<char> buffer) noexcept : buffer_(buffer) {}

    void open(char bracket) noexcept {
        put({&bracket, 1});
        first_ = true;
    }
    void close(char bracket) noexcept {
        put({&bracket, 1});
        first_ = false;
    }
    void separate() noexcept {
        if (!first_) put(", ");
        first_ = false;
    }
    void name(std::string_view name) noexcept {
        separate();
        put("\"");
        put(name);
        put("\": ");
    }
    void field(std::string_view key, std::uint64_t value) noexcept {
        name(key);
        number(value);
    }
    void field(std::string_view key, std::string_view text) noexcept {
        name(key);
        put("\"");
        put(text);
        put("\"");
    }
    /// Three decimals, the same with every library.
    void field(std::string_view key, double value) noexcept {
        name(key);
        const std::int64_t thousandths = round_to_int(value * 1000.0);
        if (thousandths < 0) put("-");
        const auto size = static_cast<std::uint64_t>(thousandths < 0 ? -thousandths : thousandths);
        number(size / 1000);
        const std::uint64_t rest = size % 1000;
        const char decimals[4] = {'.', static_cast<char>('0' + rest / 100),
                                  static_cast<char>('0' + rest / 10 % 10),
                                  static_cast<char>('0' + rest % 10)};
        put({decimals, 4});
    }
    void hexadecimal(std::string_view key, std::uint64_t value) noexcept {
        name(key);
        put("\"");
        char digits[16];
        for (unsigned i = 0; i < 16; ++i) digits[i] = "0123456789abcdef"[(value >> (60 - 4 * i)) & 15];
        put({digits, 16});
        put("\"");
    }
    void put(std::string_view text) noexcept {
        for (const char character : text) {
            if (used_ == buffer_.size()) {
                full_ = true;
                return;
            }
            buffer_[used_++] = character;
        }
    }
    [[nodiscard]] std::size_t written() const noexcept { return full_ ? 0 : used_; }

private:
    void number(std::uint64_t value) noexcept {
        char digits[20];
        const auto end = std::to_chars(digits, digits + sizeof digits, value);
        put({digits, static_cast<std::size_t>(end.ptr - digits)});
    }

    std::span<char> buffer_;
    std::size_t used_ = 0;
    bool first_ = true;
    bool full_ = false;
};

void write_stops(JsonWriter& json, const Report& report) noexcept {
    json.name("stops");
    json.open('[');
    for (const Stop& stop : report.stops) {
        json.separate();
        json.open('{');
        json.field("cause", std::string_view{name_of(stop.cause)});
        json.field("angle_deg", stop.angle_deg);
        json.field("error_deg", stop.error_deg);
        json.field("distance_deg", stop.distance_deg);
        json.field("at_pick", stop.at_pick);
        json.field("at_s", static_cast<double>(stop.at_ns) * 1e-9);
        json.close('}');
    }
    json.close(']');
}

void write_patterns(JsonWriter& json, const Report& report) noexcept {
    json.name("patterns");
    json.open('[');
    for (const LiftedPattern& each : report.patterns) {
        json.separate();
        json.open('{');
        json.field("pattern", std::uint64_t{each.pattern});
        json.field("picks", each.picks);
        json.field("first_at_pick", each.first_at_pick);
        json.close('}');
    }
    json.close(']');
}

void write_damage(JsonWriter& json, const Damage& damage) noexcept {
    json.name("damage");
    json.open('{');
    json.field("total", damage.total());
    json.field("closed_shed_wefts", damage.closed_shed_wefts);
    json.field("double_wefts", damage.double_wefts);
    json.field("late_wefts", damage.late_wefts);
    json.field("valve_after_emergency", damage.valve_after_emergency);
    json.field("tension_high", damage.tension_high);
    json.field("tension_low", damage.tension_low);
    json.field("moved_unpowered", damage.moved_unpowered);
    json.field("motor_blocked", damage.motor_blocked);
    json.field("ran_dry", damage.ran_dry);
    json.close('}');
}

} // namespace

std::size_t write_json(const Report& report, std::span<char> buffer) noexcept {
    JsonWriter json(buffer);
    json.open('{');
    json.field("seed", report.seed);
    json.field("time_s", report.time_s);
    json.field("running_s", report.running_s);
    json.field("picks", report.picks);
    json.field("picks_by_hand", report.picks_by_hand);
    json.field("empty_turns", report.empty_turns);
    json.field("picks_per_minute", report.picks_per_minute);
    json.field("weft_breaks_injected", report.weft_breaks_injected);
    json.field("warp_breaks_injected", report.warp_breaks_injected);
    json.field("patterns_repeated", report.patterns_repeated);
    write_patterns(json, report);
    json.field("yarn_cuts", report.yarn_cuts);
    json.field("stops_total", report.stops_total);
    write_stops(json, report);
    json.name("cam_error_deg");
    json.open('{');
    json.field("samples", report.cam_samples);
    json.field("p50", report.cam_error_p50_deg);
    json.field("p99", report.cam_error_p99_deg);
    json.field("max", report.cam_error_max_deg);
    json.close('}');
    json.field("emergency_stops", report.emergency_stops);
    json.field("emergency_longest_ms", report.emergency_longest_ms);
    json.field("tension_least_n", report.tension_least_n);
    json.field("tension_most_n", report.tension_most_n);
    json.field("weaving_s", report.weaving_s);
    json.field("tension_out_of_band_s", report.tension_out_of_band_s);
    json.field("drive_faults", report.drive_faults);
    json.field("frames_lost", report.frames_lost);
    json.field("edges_lost", report.edges_lost);
    write_damage(json, report.damage);
    json.hexadecimal("digest", report.digest);
    json.close('}');
    json.put("\n");
    return json.written();
}

} // namespace tappet::loom
