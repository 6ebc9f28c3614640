// The events at the angles of a turn, and the plant's measurements there.
#include "apps/carpet_loom/plant/plant.hpp"

namespace tappet::loom {
namespace {

// The marks of a turn in their order, from the beat-up on.
enum class Mark : std::uint8_t { beat_up, level };
struct MarkAt {
    Mark mark;
    double deg;
};
constexpr std::array<MarkAt, 2> marks{{{Mark::beat_up, 0.0}, {Mark::level, wires::nominal::stop_deg}}};

constexpr double running_rad_s = 60.0 * rad_s_per_rpm; // a stop from a lower speed is jogging
constexpr double weaving_rad_s = 0.9 * wires::nominal::speed_rpm * rad_s_per_rpm;
constexpr Duration settling = 500ms; // after the run-up, before tension counts
constexpr Duration unpowered_limit = 50ms;
constexpr Duration dry_limit = 8s;

} // namespace

void Plant::pass_marks(double position_deg) noexcept TAPPET_REALTIME {
    while (position_deg >= next_mark_deg_) {
        switch (marks[next_mark_].mark) {
        case Mark::beat_up:
            turn_deg_ = next_mark_deg_;
            beat_up();
            break;
        case Mark::level:
            if (!dobby_.cross(step_end_, wire_)) ++report_.patterns_repeated;
            note_pattern();
            break;
        }
        const double here = marks[next_mark_].deg;
        next_mark_ = (next_mark_ + 1) % marks.size();
        const double there = marks[next_mark_].deg;
        next_mark_deg_ += there > here ? there - here : there + 360.0 - here;
    }
}

void Plant::note_pattern() noexcept TAPPET_REALTIME {
    for (LiftedPattern& each : report_.patterns)
        if (each.pattern == dobby_.pattern()) {
            ++each.picks;
            return;
        }
    static_cast<void>(report_.patterns.push({dobby_.pattern(), 1, report_.picks}));
}

void Plant::beat_up() noexcept TAPPET_REALTIME {
    if (insertion_.arrived()) {
        ++report_.picks;
        log_.add(to_ns(step_end_));
    } else if (insertion_.by_hand()) {
        ++report_.picks_by_hand;
    } else {
        ++report_.empty_turns;
    }
    insertion_.next_shed();
    warp_.thin_beam();
    run_script();
    draw_troubles();
}

void Plant::open_valve(Time at) noexcept TAPPET_REALTIME {
    const bool breaks = next_weft_breaks_;
    const bool fed = feeder_.fed();
    switch (insertion_.open(position_deg_at(at), fed, breaks, random_)) {
    case Release::nothing: return;
    case Release::closed_shed: ++report_.damage.closed_shed_wefts; return;
    case Release::second_weft: ++report_.damage.double_wefts; return;
    case Release::flies: break;
    }
    feeder_.draw();
    if (breaks) {
        next_weft_breaks_ = false;
        ++report_.weft_breaks_injected;
    }
    if (!breaks && fed) return;
    weft_missing_ = true;
    blame(StopCause::weft);
}

void Plant::blame(StopCause cause) noexcept TAPPET_REALTIME {
    if (moving_) causes_ |= 1u << static_cast<unsigned>(cause);
}

void Plant::measure_motion(double turned_deg, Duration dt) noexcept TAPPET_REALTIME {
    const double speed = std::abs(shaft_.speed_rad_s());
    if (!moving_ && turned_deg != 0.0) {
        moving_ = true;
        braked_ = false;
        fastest_rad_s_ = 0.0;
        causes_ = 0;
        emergency_at_ = never;
    }
    running_ += dt;
    fastest_rad_s_ = std::max(fastest_rad_s_, speed);
    if (shaft_.position_deg() >= warp_breaks_at_deg_) {
        warp_breaks_at_deg_ = 1e18;
        ++report_.warp_breaks_injected;
        contacts_[wires::line::drop_wire].set(true, step_end_, random_, edges_);
        blame(StopCause::warp);
    }

    const bool powered = main_.power() != Power::off;
    unpowered_ = powered || brake_.on() || speed < 1.0 ? Duration{} : unpowered_ + dt;
    if (unpowered_ > unpowered_limit && unpowered_ - dt <= unpowered_limit) ++report_.damage.moved_unpowered;
    const bool dry =
        climate_.oil_bar() < 0.5 * wires::nominal::oil_pressure_least_bar && speed > running_rad_s;
    dry_ = dry ? dry_ + dt : Duration{};
    if (dry_ > dry_limit && dry_ - dt <= dry_limit) ++report_.damage.ran_dry;

    const double tension = warp_.tension_n(shaft_.position_deg());
    const bool low = tension < Warp::hard_low_n && speed > running_rad_s;
    const bool high = tension > Warp::hard_high_n;
    if (high && !tension_was_hard_) ++report_.damage.tension_high;
    if (low && !tension_was_hard_) ++report_.damage.tension_low;
    tension_was_hard_ = low || high;

    at_speed_ = speed > weaving_rad_s ? at_speed_ + dt : Duration{};
    if (at_speed_ < settling) return;
    if (weaving_ == Duration{}) report_.tension_least_n = report_.tension_most_n = tension;
    weaving_ += dt;
    report_.tension_least_n = std::min(report_.tension_least_n, tension);
    report_.tension_most_n = std::max(report_.tension_most_n, tension);
    if (std::abs(tension - wires::nominal::tension_n) > wires::nominal::tension_band_n) out_of_band_ += dt;
}

void Plant::record_standstill(Time at) noexcept TAPPET_REALTIME {
    const bool ran = fastest_rad_s_ > running_rad_s;
    moving_ = false;
    at_speed_ = Duration{};
    if (!ran) return;
    brake_.wear(random_);
    Stop stop;
    stop.at_ns = to_ns(at);
    stop.at_pick = report_.picks;
    stop.angle_deg = angle_of_position(shaft_.position_deg());
    stop.error_deg = wrapped_deg(stop.angle_deg - wires::nominal::stop_deg);
    stop.distance_deg = braked_ ? shaft_.position_deg() - brake_edge_deg_ : 0.0;
    // The most important cause stands first in StopCause.
    for (unsigned cause = static_cast<unsigned>(StopCause::machine); cause-- > 0;)
        if ((causes_ & (1u << cause)) != 0) stop.cause = static_cast<StopCause>(cause);
    if (emergency_at_ != never) {
        ++report_.emergency_stops;
        const double took_ms = to_seconds(at - emergency_at_) * 1e3;
        report_.emergency_longest_ms = std::max(report_.emergency_longest_ms, took_ms);
        emergency_at_ = never;
    }
    ++report_.stops_total;
    static_cast<void>(report_.stops.push(stop)); // a full list keeps its first rows
    log_.add(stop.at_ns);
    log_.add(round_to_int(stop.angle_deg * 1e6));
}

Report Plant::report() const noexcept TAPPET_REALTIME {
    Report report = report_;
    report.seed = seed_;
    report.time_s = to_seconds(now_ - Time{});
    report.running_s = to_seconds(running_);
    if (running_ > Duration{})
        report.picks_per_minute = static_cast<double>(report.picks) * 60.0 / report.running_s;
    report.cam_samples = cam_errors_.samples();
    report.cam_error_p50_deg = cam_errors_.percentile_deg(50);
    report.cam_error_p99_deg = cam_errors_.percentile_deg(99);
    report.cam_error_max_deg = cam_errors_.max_deg();
    report.weaving_s = to_seconds(weaving_);
    report.tension_out_of_band_s = to_seconds(out_of_band_);
    report.drive_faults = main_.faults() + let_off_.faults();
    report.frames_lost = wire_.lost();
    report.edges_lost = edges_.lost();
    Digest digest = log_;
    digest.add(wire_.log().value());
    digest.add(edges_.log().value());
    report.digest = digest.value();
    return report;
}

} // namespace tappet::loom
