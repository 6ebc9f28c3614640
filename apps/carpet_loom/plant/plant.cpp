// The plant's time: integration steps on a fixed grid, and between them timers in the order they are due.
#include "apps/carpet_loom/plant/plant.hpp"

namespace tappet::loom {
namespace {

constexpr double main_unit_rad_s = rad_s_per_rpm / wires::main_velocity_per_rpm;
constexpr double let_off_unit_rad_s = rad_s_per_rpm / wires::let_off_velocity_per_rpm;
constexpr Duration blocked_limit = 500ms;
constexpr double load_cell_noise_n = 2.0;

} // namespace

Plant::Plant(const Settings& settings, std::uint64_t seed) noexcept TAPPET_REALTIME
    : settings_(settings),
      seed_(seed),
      random_(seed),
      main_(wires::node::main_drive, wires::main_velocity_per_rpm, random_),
      let_off_(wires::node::let_off_drive, wires::let_off_velocity_per_rpm, random_),
      encoder_(wires::node::encoder, random_),
      load_cell_(wires::node::load_cell, random_),
      feeder_(random_),
      dobby_(random_),
      shaft_(random_),
      brake_(settings.brake_wear_per_stop, random_),
      warp_(random_),
      insertion_(random_),
      climate_(random_),
      operator_(settings.operator_reaction),
      contacts_{Contact{wires::line::emergency_stop, settings.contact_bounce},
                Contact{wires::line::drop_wire, settings.contact_bounce},
                Contact{wires::line::weft_detector, false},
                Contact{wires::line::button_start, settings.contact_bounce},
                Contact{wires::line::button_stop, settings.contact_bounce},
                Contact{wires::line::button_acknowledge, settings.contact_bounce}},
      next_mark_deg_(360.0),
      warp_breaks_at_deg_(1e18) {
    run_script();
    begin_step();
    find_next_timer();
}

void Plant::advance(Time now) noexcept TAPPET_REALTIME {
    for (Time next; (next = next_event()) <= now;) pass(next);
    now_ = std::max(now_, now);
}

Time Plant::leap(Time until) noexcept TAPPET_REALTIME {
    for (Time next; wire_.empty() && edges_.empty(); pass(next))
        if ((next = next_event()) >= until) return next;
    return now_;
}

void Plant::pass(Time next) noexcept TAPPET_REALTIME {
    now_ = next;
    if (step_end_ <= next_timer_) {
        end_step();
        begin_step();
    } else {
        run_timers(next);
    }
    find_next_timer();
}

void Plant::begin_step() noexcept TAPPET_REALTIME {
    step_begin_ = step_end_;
    const double main_target = main_unit_rad_s * static_cast<double>(main_.target());
    const double speed = shaft_.speed_rad_s();
    const std::uint64_t faults_before = main_.faults() + let_off_.faults();
    main_.supervise(speed > -0.05 && speed < 0.05, std::abs(speed - main_target) < 0.5, shaft_.saturated(),
                    step_begin_, wire_);
    const double let_off_target = let_off_unit_rad_s * static_cast<double>(let_off_.target());
    let_off_.supervise(warp_.standing(), std::abs(warp_.beam_rad_s() - let_off_target) < 0.002, false,
                       step_begin_, wire_);

    const bool main_idle = main_.power() == Power::off || main_.target() == 0;
    const bool let_off_idle = let_off_.power() != Power::follow || let_off_.target() == 0;
    resting_ = speed == 0.0 && main_idle && let_off_idle && brake_.at_rest() && warp_.standing();
    step_end_ = step_begin_ + (resting_ ? resting_step : step);
    const double dt_s = to_seconds(step_end_ - step_begin_);
    brake_.step(step_begin_, dt_s);
    shaft_.begin_step(main_.power(), main_target, brake_.torque_nm(), dt_s);

    const bool blocked = shaft_.saturated() && shaft_.standing();
    if (!blocked)
        blocked_since_ = never;
    else if (blocked_since_ == never)
        blocked_since_ = step_begin_;
    else if (step_begin_ - blocked_since_ > blocked_limit && main_.power() == Power::follow) {
        ++report_.damage.motor_blocked;
        main_.trip(wires::emergency_code::motor_blocked, step_begin_, wire_);
    }
    if (main_.faults() + let_off_.faults() != faults_before) blame(StopCause::fault);
}

void Plant::end_step() noexcept TAPPET_REALTIME {
    const double before = shaft_.position_deg();
    const bool stopped = shaft_.end_step();
    const double after = shaft_.position_deg();
    const Duration dt = step_end_ - step_begin_;
    const double dt_s = to_seconds(dt);
    warp_.step(let_off_.power(), let_off_unit_rad_s * static_cast<double>(let_off_.target()), after - before,
               dt_s);
    if (after == before && !stopped) return;
    insertion_.follow(before, after, step_begin_, dt_s);
    pass_marks(after);
    dobby_.follow(after - turn_deg_, step_end_, wire_);
    measure_motion(after - before, dt);
    if (stopped) record_standstill(step_begin_ + Duration{round_to_int(shaft_.stopped_into_s() * 1e9)});
}

void Plant::shorten_rest() noexcept TAPPET_REALTIME {
    if (!resting_) return;
    // Nothing moves in a resting step, so it may end at any point of the finer grid.
    const Duration into = now_ - step_begin_;
    step_end_ = std::min(step_end_, step_begin_ + (into / step + 1) * step);
}

void Plant::find_next_timer() noexcept TAPPET_REALTIME {
    Time next = std::min({main_.node().next(), let_off_.node().next(), encoder_.next(), load_cell_.next(),
                          feeder_.node().next(), dobby_.node().next(), insertion_.next(), climate_at_,
                          operator_at_, valve_check_at_, faults_end_at_});
    next_timer_ = std::min(next, next_contact());
}

void Plant::run_timers(Time now) noexcept TAPPET_REALTIME {
    tick_nodes(now);
    if (insertion_.measure_at() <= now) {
        insertion_.measured();
        cam_errors_.add(wrapped_deg(position_deg_at(now) - wires::nominal::weft_release_deg));
    }
    if (insertion_.open_at() <= now) open_valve(now);
    if (insertion_.arrive_at() <= now) {
        insertion_.arrive();
        const double angle = position_deg_at(now) - turn_deg_;
        if (angle > wires::nominal::shed_closed_deg) ++report_.damage.late_wefts;
        contacts_[wires::line::weft_detector].set(true, now, random_, edges_, now + wires::weft_pulse);
    }
    for (Contact& contact : contacts_)
        if (contact.next() <= now) contact.tick(now, random_, edges_);
    if (valve_check_at_ <= now) {
        valve_check_at_ = never;
        if (insertion_.line()) ++report_.damage.valve_after_emergency;
    }
    if (faults_end_at_ <= now) end_faults(now, false);
    if (climate_at_ <= now) {
        climate_at_ = now + Climate::period;
        climate_.step();
    }
    if (operator_at_ <= now) {
        operator_at_ = now + Operator::period;
        work(now);
    }
}

void Plant::tick_nodes(Time now) noexcept TAPPET_REALTIME {
    const double into_s = into_step_s(now);
    if (main_.node().next() <= now && main_.node().tick(now, wire_))
        main_.send_status(shaft_.speed_rad_s_at(into_s) / rad_s_per_rpm, wire_);
    if (let_off_.node().next() <= now && let_off_.node().tick(now, wire_))
        let_off_.send_status(warp_.beam_rad_s() / rad_s_per_rpm, wire_);
    if (encoder_.next() <= now && encoder_.tick(now, wire_)) {
        encoder_.set(0x2100, encoder_code_at(now));
        encoder_.set(0x2101, encoder_samples_++);
        encoder_.send_due(wire_);
    }
    if (load_cell_.next() <= now && load_cell_.tick(now, wire_)) {
        const double first = random_.unit();
        const double second = random_.unit();
        const double noisy =
            warp_.tension_n(shaft_.position_deg_at(into_s)) + load_cell_noise_n * (first - second);
        const std::uint8_t status = noisy > Warp::hard_high_n
                                        ? wires::load_cell_bit::valid | wires::load_cell_bit::overload
                                        : wires::load_cell_bit::valid;
        load_cell_.set({0x7130, 1}, static_cast<std::uint64_t>(round_to_int(noisy * wires::tension_per_n)));
        load_cell_.set({0x6150, 1}, status);
        load_cell_.send_due(wire_);
    }
    if (feeder_.node().next() <= now && feeder_.node().tick(now, wire_)) feeder_.send_status(wire_);
    if (dobby_.node().next() <= now && dobby_.node().tick(now, wire_)) dobby_.node().send_due(wire_);
}
static_assert((wires::encoder_codes_per_turn & (wires::encoder_codes_per_turn - 1)) == 0,
              "codes are masked out of the position");

void Plant::hear(std::uint8_t node, canopen::SimulatedNode::Heard what) noexcept TAPPET_REALTIME {
    using Heard = canopen::SimulatedNode::Heard;
    if (what == Heard::reset) restart_application(node);
    if (what == Heard::started && node == wires::node::dobby) dobby_.introduce(now_, wire_);
    if (what != Heard::process_data) return;
    switch (node) {
    case wires::node::main_drive: main_.command(now_, wire_); break;
    case wires::node::let_off_drive: let_off_.command(now_, wire_); break;
    case wires::node::feeder: feeder_.command(); break;
    case wires::node::dobby: dobby_.command(); break;
    default: break;
    }
}

void Plant::receive(const can::Frame& frame, Time now) noexcept TAPPET_REALTIME {
    advance(now);
    Wire::note(frame, now_, log_);
    for (std::uint8_t id = 1; id <= wires::node::count; ++id)
        hear(id, node_of(id)->receive(frame, now_, wire_));
    if (frame.id == wires::cob::main_drive_command || frame.id == wires::cob::let_off_drive_command)
        shorten_rest();
    find_next_timer();
}

void Plant::set_line(unsigned output, bool level, Time now) noexcept TAPPET_REALTIME {
    namespace line = wires::line;
    advance(now);
    if (output < line::first_output || output >= line::first_output + line::output_count) return;
    bool& state = outputs_[output - line::first_output];
    if (state == level) return;
    state = level;
    log_.add(to_ns(now_));
    log_.add(std::uint64_t{output} * 2 + (level ? 1 : 0));
    if (output == line::weft_release) {
        insertion_.set_valve(level, now_);
        if (level && contacts_[line::emergency_stop].closed()) ++report_.damage.valve_after_emergency;
    }
    if (output == line::brake) {
        brake_.set(level, now_);
        shorten_rest();
        if (level && !braked_) {
            braked_ = true;
            brake_edge_deg_ = position_deg();
        }
    }
    if (output == line::yarn_cutter && level) ++report_.yarn_cuts;
    find_next_timer();
}

bool Plant::line(unsigned input) const noexcept TAPPET_REALTIME {
    return input < contacts_.size() && contacts_[input].level();
}

} // namespace tappet::loom
