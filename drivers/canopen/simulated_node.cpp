// A simulated node's reaction to frames and time.
#include "drivers/canopen/simulated_node.hpp"

#include "drivers/canopen/frames.hpp"

namespace tappet::canopen {
namespace {

constexpr std::uint16_t first_tpdo = 0x1800, first_rpdo = 0x1400, to_mapping = 0x200;

constexpr bool is_of(std::uint16_t index, std::uint16_t first) noexcept TAPPET_REALTIME {
    return index >= first && index < first + predefined_pdos;
}

} // namespace

void SimulatedNode::begin(Time boots_at) noexcept TAPPET_REALTIME {
    stop_work(NmtState::boot_up);
    is_on_ = true;
    beat_at_ = master_lost_at_ = never;
    boots_at_ = boots_at;
    server_.forget();
}

void SimulatedNode::stop_work(NmtState state) noexcept TAPPET_REALTIME {
    state_ = state;
    for (Pdo& pdo : sent_) pdo = {};
    for (Pdo& pdo : taken_) pdo = {};
    if (state == NmtState::boot_up) beat_at_ = master_lost_at_ = never;
}

void SimulatedNode::start_work(Time now) noexcept TAPPET_REALTIME {
    state_ = NmtState::operational;
    for (std::uint16_t n = 0; n < predefined_pdos; ++n) {
        read_pdo(sent_[n], static_cast<std::uint16_t>(first_tpdo + n), now);
        read_pdo(taken_[n], static_cast<std::uint16_t>(first_rpdo + n), now);
    }
}

/// Reads the PDO's configuration from the objects.
void SimulatedNode::read_pdo(Pdo& pdo, std::uint16_t communication, Time now) noexcept TAPPET_REALTIME {
    pdo = {};
    const auto mapping = static_cast<std::uint16_t>(communication + to_mapping);
    const std::uint64_t entry = get({communication, 1});
    if (!has({communication, 1}) || (entry & pdo_invalid) != 0) return;
    pdo.identifier = static_cast<std::uint32_t>(entry & 0x7FF);
    pdo.type = static_cast<std::uint8_t>(get({communication, 2}));
    const std::uint64_t count = get({mapping, 0});
    for (std::uint8_t i = 1; i <= count; ++i) {
        const std::uint64_t row = get({mapping, i});
        const Object* const object =
            dictionary().find({static_cast<std::uint16_t>(row >> 16), static_cast<std::uint8_t>(row >> 8)});
        if (object == nullptr || pdo.bits + bits_of(object->type) > 64) return;
        pdo.bits += bits_of(object->type);
        if (!pdo.objects.push(static_cast<std::uint16_t>(index_of(*object)))) return;
    }
    pdo.valid = true;
    pdo.timer = own(std::chrono::milliseconds{get({communication, 5})});
    if (communication >= first_tpdo && pdo.type >= 254 && pdo.timer > Duration{})
        pdo.timer_at = now + pdo.timer;
}

void SimulatedNode::emit(can::Frame frame, Time due, FrameSink& out) const noexcept TAPPET_REALTIME {
    if (!alive()) return;
    frame.stamp = due;
    out.send(frame);
}

bool SimulatedNode::tick(Time now, FrameSink& out) noexcept TAPPET_REALTIME {
    if (boots_at_ <= now) {
        const Time at = boots_at_;
        boots_at_ = never;
        state_ = NmtState::pre_operational;
        emit(heartbeat_frame(id(), NmtState::boot_up), at, out);
        now_ = at;
        written(0x1017);
    }
    if (beat_at_ <= now) {
        emit(heartbeat_frame(id(), state_), beat_at_, out);
        beat_at_ += own(std::chrono::milliseconds{get(0x1017)});
    }
    if (master_lost_at_ <= now) {
        const Time at = master_lost_at_;
        master_lost_at_ = never;
        send_emergency(emergency_code::heartbeat, 0x11, at, out);
        if (operational()) stop_work(NmtState::pre_operational); // by 1029h's default
    }
    bool any = false;
    for (Pdo& pdo : sent_) {
        if (pdo.timer_at <= now) {
            pdo.due = pdo.timer_at;
            pdo.timer_at += pdo.timer;
        }
        any |= pdo.due != never;
    }
    return any;
}

can::Frame SimulatedNode::pack(const Pdo& pdo) noexcept TAPPET_REALTIME {
    can::Frame frame{.id = pdo.identifier, .length = static_cast<std::uint8_t>((pdo.bits + 7) / 8)};
    std::uint64_t whole = 0;
    unsigned at = 0;
    for (const std::uint16_t place : pdo.objects) {
        whole |= value_at(place) << at;
        at += bits_of(dictionary().objects[place].type);
    }
    to_bytes(whole, frame.data);
    return frame;
}

void SimulatedNode::send_due(FrameSink& out) noexcept TAPPET_REALTIME {
    for (Pdo& pdo : sent_) {
        if (pdo.due == never) continue;
        emit(pack(pdo), pdo.due, out);
        pdo.due = never;
    }
}

void SimulatedNode::send_pdo(std::size_t number, Time due, FrameSink& out) noexcept TAPPET_REALTIME {
    if (number >= sent_.size() || !sent_[number].valid) return;
    Pdo& pdo = sent_[number];
    if (pdo.type >= 254)
        emit(pack(pdo), due, out);
    else
        pdo.changed = true;
}

SimulatedNode::Heard SimulatedNode::receive(const can::Frame& frame, Time now, FrameSink& out) noexcept
    TAPPET_REALTIME {
    if (!alive() || frame.extended || frame.remote) return Heard::nothing;
    if (frame.id == cob::nmt) return manage(frame, now);
    if (frame.id == cob::sdo_request + id()) {
        serve(frame, now, out);
        return Heard::nothing;
    }
    if (frame.id == cob::sync) return synchronise(now) ? Heard::process_data : Heard::nothing;
    const std::uint64_t watched = get({0x1016, 1});
    if (watched != 0 && frame.id == cob::heartbeat + (watched >> 16 & 0x7F)) {
        master_lost_at_ = now + own(std::chrono::milliseconds{watched & 0xFFFF});
        return Heard::nothing;
    }
    return take_pdo(frame, now, out) ? Heard::process_data : Heard::nothing;
}

SimulatedNode::Heard SimulatedNode::manage(const can::Frame& frame, Time now) noexcept TAPPET_REALTIME {
    if (frame.length != 2 || (frame.data[1] != 0 && frame.data[1] != id())) return Heard::nothing;
    switch (NmtCommand{frame.data[0]}) {
    case NmtCommand::start:
        if (operational()) return Heard::nothing;
        start_work(now);
        return Heard::started;
    case NmtCommand::stop: stop_work(NmtState::stopped); break;
    case NmtCommand::enter_pre_operational: stop_work(NmtState::pre_operational); break;
    case NmtCommand::reset_communication:
        reset(0x1000, 0x1FFF);
        begin(now + boot_time);
        break;
    case NmtCommand::reset_node: power_on(now + boot_time); return Heard::reset;
    }
    return Heard::nothing;
}

void SimulatedNode::serve(const can::Frame& frame, Time now, FrameSink& out) noexcept TAPPET_REALTIME {
    if (is_mute_ || state_ == NmtState::stopped || frame.length != 8) return;
    now_ = now;
    can::Frame answer{.id = cob::sdo_answer + id(), .length = 8};
    if (server_.serve(frame.data, *this, answer.data)) emit(answer, now, out);
}

bool SimulatedNode::synchronise(Time now) noexcept TAPPET_REALTIME {
    for (Pdo& pdo : sent_) {
        if (!pdo.valid || pdo.type > 240) continue;
        ++pdo.syncs;
        const bool is_due = pdo.type == 0 ? pdo.changed : pdo.syncs >= pdo.type;
        if (!is_due) continue;
        pdo.syncs = 0;
        pdo.changed = false;
        pdo.due = now;
    }
    bool any = false;
    for (Pdo& pdo : taken_) {
        if (!pdo.changed) continue;
        pdo.changed = false;
        unpack(pdo, pdo.held);
        any = true;
    }
    return any;
}

void SimulatedNode::unpack(const Pdo& pdo, std::uint64_t whole) noexcept TAPPET_REALTIME {
    unsigned at = 0;
    for (const std::uint16_t place : pdo.objects) {
        const unsigned wide = bits_of(dictionary().objects[place].type);
        value_at(place) = low_bits(at < 64 ? whole >> at : 0, wide);
        at += wide;
    }
}

bool SimulatedNode::take_pdo(const can::Frame& frame, Time now, FrameSink& out) noexcept TAPPET_REALTIME {
    for (Pdo& pdo : taken_) {
        if (!pdo.valid || pdo.identifier != frame.id) continue;
        if (8u * frame.length < pdo.bits) {
            send_emergency(emergency_code::pdo_too_short, 0x11, now, out);
            return false;
        }
        pdo.held = from_bytes(frame.data);
        pdo.changed = pdo.type <= 240;
        if (!pdo.changed) unpack(pdo, pdo.held);
        return !pdo.changed;
    }
    return false;
}

void SimulatedNode::send_emergency(std::uint16_t code, std::uint8_t error_register, Time due,
                                   FrameSink& out) noexcept TAPPET_REALTIME {
    set(0x1001, error_register);
    if (code != 0) {
        set({0x1003, 0}, 1);
        set({0x1003, 1}, code);
    } else {
        set({0x1003, 0}, 0);
    }
    emit({.id = cob::emergency + id(),
          .length = 8,
          .data = {static_cast<std::uint8_t>(code & 0xFF), static_cast<std::uint8_t>(code >> 8),
                   error_register}},
         due, out);
}

SdoAbort SimulatedNode::may_write(const Object& object, std::uint64_t bits) noexcept TAPPET_REALTIME {
    const std::uint16_t index = object.at.index;
    const bool communicates = is_of(index, first_tpdo) || is_of(index, first_rpdo);
    const bool maps = is_of(index, first_tpdo + to_mapping) || is_of(index, first_rpdo + to_mapping);
    if (communicates && object.at.sub == 1) {
        const std::uint64_t old = get(object.at);
        const bool stays_valid = (old & pdo_invalid) == 0 && (bits & pdo_invalid) == 0;
        return stays_valid && (old & 0x1FFF'FFFF) != (bits & 0x1FFF'FFFF) ? SdoAbort::invalid_value
                                                                          : SdoAbort::none;
    }
    if (communicates && object.at.sub == 2)
        return bits > 240 && bits < 252 ? SdoAbort::invalid_value : SdoAbort::none;
    return maps ? may_map(object.at, bits) : SdoAbort::none;
}

SdoAbort SimulatedNode::may_map(Address mapping, std::uint64_t bits) const noexcept TAPPET_REALTIME {
    const auto communication = static_cast<std::uint16_t>(mapping.index - to_mapping);
    if ((get({communication, 1}) & pdo_invalid) == 0) return SdoAbort::unsupported_access;
    if (mapping.sub == 0) {
        unsigned all = 0;
        for (std::uint8_t i = 1; i <= bits; ++i) all += static_cast<unsigned>(get({mapping.index, i}) & 0xFF);
        return all > 64 ? SdoAbort::pdo_length : SdoAbort::none;
    }
    if (get({mapping.index, 0}) != 0) return SdoAbort::unsupported_access;
    const Object* const object =
        dictionary().find({static_cast<std::uint16_t>(bits >> 16), static_cast<std::uint8_t>(bits >> 8)});
    const bool is_sent = communication >= first_tpdo;
    if (object == nullptr) return SdoAbort::no_object;
    if (!object->mappable || (bits & 0xFF) != bits_of(object->type) ||
        !(is_sent ? readable(object->access) : writable(object->access)))
        return SdoAbort::not_mappable;
    return SdoAbort::none;
}

void SimulatedNode::written(Address at) noexcept TAPPET_REALTIME {
    if (at.index == 0x1017) {
        const auto every = own(std::chrono::milliseconds{get(0x1017)});
        beat_at_ = every > Duration{} ? now_ + every : never;
    }
    if (!operational()) return;
    const auto n = static_cast<std::size_t>(at.index & 0xF);
    if (is_of(at.index, first_tpdo)) read_pdo(sent_[n], at.index, now_);
    if (is_of(at.index, first_rpdo)) read_pdo(taken_[n], at.index, now_);
}

} // namespace tappet::canopen
