// Faults by script, by chance and on demand, and the operator who repairs them.
#include "apps/carpet_loom/plant/plant.hpp"

namespace tappet::loom {

canopen::SimulatedNode* Plant::node_of(std::uint8_t id) noexcept TAPPET_REALTIME {
    switch (id) {
    case wires::node::main_drive: return &main_.node();
    case wires::node::let_off_drive: return &let_off_.node();
    case wires::node::encoder: return &encoder_;
    case wires::node::load_cell: return &load_cell_;
    case wires::node::feeder: return &feeder_.node();
    case wires::node::dobby: return &dobby_.node();
    default: return nullptr;
    }
}

void Plant::restart_application(std::uint8_t id) noexcept TAPPET_REALTIME {
    switch (id) {
    case wires::node::main_drive: main_.restart(); break;
    case wires::node::let_off_drive: let_off_.restart(); break;
    case wires::node::encoder: encoder_samples_ = 0; break;
    case wires::node::feeder: feeder_.restart(); break;
    case wires::node::dobby: dobby_.restart(); break;
    default: break;
    }
}

void Plant::start_fault(const ScriptedFault& row) noexcept TAPPET_REALTIME {
    bool stays = true;
    switch (row.fault) {
    case Fault::weft_break:
        next_weft_breaks_ = true;
        stays = false;
        break;
    case Fault::warp_break:
        warp_breaks_at_deg_ = shaft_.position_deg() + 360.0 * random_.unit();
        stays = row.lasts > Duration{}; // the drop wire itself stays broken
        break;
    case Fault::node_lost: {
        canopen::SimulatedNode* const node = node_of(row.node);
        if (node == nullptr) return;
        node->power_off();
        restart_application(row.node);
        blame(StopCause::fault);
        break;
    }
    case Fault::drive_fault:
        if (row.node == wires::node::let_off_drive)
            let_off_.trip(wires::emergency_code::over_current, now_, wire_);
        else
            main_.trip(wires::emergency_code::over_current, now_, wire_);
        blame(StopCause::fault);
        stays = false;
        break;
    case Fault::oil_lost:
        climate_.lose_oil(true);
        blame(StopCause::fault);
        break;
    case Fault::oil_level_low: climate_.set_oil_level_low(true); break;
    case Fault::feeder_empty:
        feeder_.run_out();
        blame(StopCause::weft);
        break;
    case Fault::emergency_stop:
        contacts_[wires::line::emergency_stop].set(true, now_, random_, edges_);
        valve_check_at_ = now_ + 5ms; // long enough for any machine to close it
        if (moving_ && emergency_at_ == never) emergency_at_ = now_;
        blame(StopCause::emergency);
        break;
    case Fault::operator_stop:
        contacts_[wires::line::button_stop].set(true, now_, random_, edges_, now_ + Operator::press);
        blame(StopCause::operator_stop);
        stays = false;
        break;
    }
    if (!stays) return;
    const Time until = row.lasts > Duration{} ? now_ + row.lasts : never;
    if (!active_.push({row.fault, row.node, until})) return; // a loom has at most 16 faults at once
    faults_end_at_ = std::min(faults_end_at_, until);
}

void Plant::end_fault(const ActiveFault& active) noexcept TAPPET_REALTIME {
    switch (active.fault) {
    case Fault::node_lost:
        if (auto* const node = node_of(active.node)) node->power_on(now_ + canopen::SimulatedNode::boot_time);
        break;
    case Fault::warp_break: contacts_[wires::line::drop_wire].set(false, now_, random_, edges_); break;
    case Fault::oil_lost: climate_.lose_oil(false); break;
    case Fault::oil_level_low: climate_.set_oil_level_low(false); break;
    case Fault::feeder_empty: feeder_.new_bobbin(); break;
    case Fault::emergency_stop:
        contacts_[wires::line::emergency_stop].set(false, now_, random_, edges_);
        break;
    case Fault::weft_break:
    case Fault::drive_fault:
    case Fault::operator_stop: break;
    }
}

void Plant::end_faults(Time now, bool repaired) noexcept TAPPET_REALTIME {
    faults_end_at_ = never;
    Bounded<ActiveFault, 16> left;
    for (const ActiveFault& active : active_) {
        if (active.until <= now || (repaired && active.until == never)) {
            end_fault(active);
        } else {
            static_cast<void>(left.push(active)); // as large as its source
            faults_end_at_ = std::min(faults_end_at_, active.until);
        }
    }
    active_ = left;
}

bool Plant::broken() const noexcept TAPPET_REALTIME {
    if (weft_missing_ || contacts_[wires::line::drop_wire].closed()) return true;
    for (const ActiveFault& active : active_)
        if (active.until == never) return true;
    return false;
}

void Plant::repair() noexcept TAPPET_REALTIME {
    if (weft_missing_) {
        weft_missing_ = false;
        if (insertion_.released() && !insertion_.arrived()) insertion_.lay_by_hand();
    }
    contacts_[wires::line::drop_wire].set(false, now_, random_, edges_);
    end_faults(now_, true);
    find_next_timer();
}

void Plant::press(Button button, Duration lasts) noexcept TAPPET_REALTIME {
    namespace line = wires::line;
    switch (button) {
    case Button::emergency_stop: start_fault({.fault = Fault::emergency_stop, .lasts = lasts}); break;
    case Button::stop:
        contacts_[line::button_stop].set(true, now_, random_, edges_, now_ + lasts);
        blame(StopCause::operator_stop);
        break;
    case Button::start: contacts_[line::button_start].set(true, now_, random_, edges_, now_ + lasts); break;
    case Button::acknowledge:
        contacts_[line::button_acknowledge].set(true, now_, random_, edges_, now_ + lasts);
        break;
    }
    find_next_timer();
}

void Plant::inject(const ScriptedFault& fault) noexcept TAPPET_REALTIME {
    start_fault(fault);
    find_next_timer();
}

void Plant::run_script() noexcept TAPPET_REALTIME {
    for (std::size_t row = 0; row < settings_.script.size(); ++row) {
        const std::uint32_t bit = std::uint32_t{1} << row;
        const ScriptedFault& fault = settings_.script[row];
        if ((script_done_ & bit) != 0 || (fault.at > now_ && fault.at_pick > report_.picks)) continue;
        script_done_ |= bit;
        start_fault(fault);
    }
}
static_assert(decltype(Settings::script)::capacity() <= 32, "one bit per row of the script");

void Plant::draw_troubles() noexcept TAPPET_REALTIME {
    if (random_.one_in(settings_.weft_break_one_in)) start_fault({.fault = Fault::weft_break});
    if (random_.one_in(settings_.warp_break_one_in) && !contacts_[wires::line::drop_wire].closed())
        start_fault({.fault = Fault::warp_break});
    if (random_.one_in(settings_.operator_stop_one_in)) start_fault({.fault = Fault::operator_stop});
    if (random_.one_in(settings_.emergency_stop_one_in) && !contacts_[wires::line::emergency_stop].closed())
        start_fault({.fault = Fault::emergency_stop});
}

void Plant::work(Time now) noexcept TAPPET_REALTIME {
    namespace line = wires::line;
    run_script();
    if (!settings_.operator_present) return;
    const bool finished = settings_.last_pick > 0 && report_.picks >= settings_.last_pick;
    if (finished && !stop_pressed_at_end_) {
        stop_pressed_at_end_ = true;
        press(Button::stop, Operator::press);
    }
    const auto lamp = [this](unsigned output) { return outputs_[output - line::first_output]; };
    const Operator::Sight sight{.lamp_run = lamp(line::lamp_run),
                                .lamp_stop = lamp(line::lamp_stop),
                                .lamp_fault = lamp(line::lamp_fault),
                                .standing = shaft_.standing(),
                                .broken = broken(),
                                .finished = finished};
    switch (operator_.look(sight, now)) {
    case Operator::Action::none: break;
    case Operator::Action::repair: repair(); break;
    case Operator::Action::acknowledge: press(Button::acknowledge, Operator::press); break;
    case Operator::Action::start: press(Button::start, Operator::press); break;
    }
}

} // namespace tappet::loom
