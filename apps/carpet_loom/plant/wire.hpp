// The loom's end of the CAN bus: what its nodes send and hear, by the names of the machine's map.
#pragma once

#include "apps/carpet_loom/maps.hpp"
#include "apps/carpet_loom/plant/outbox.hpp"
#include "drivers/can/node_signals.hpp"
#include "kernel/base/digest.hpp"

#include <bit>
#include <cstdint>

namespace tappet::loom {

// clang-format off
/// What the drives send that the loom's machine does not listen to (CiA 301).
inline constexpr auto emergencies = can::signal_map(
    can::receive(can::standard(wires::cob::emergency + wires::node::main_drive), "main_drive", can::bytes(8), can::on_demand(10ms),
        can::signal("code", 0, 16), can::signal("register", 16, 8)),
    can::receive(can::standard(wires::cob::emergency + wires::node::let_off_drive), "let_off", can::bytes(8), can::on_demand(10ms),
        can::signal("code", 0, 16), can::signal("register", 16, 8)));
// clang-format on

/// Keeps a digest of everything that ever went out, fetched or not. A frame's stamp is when its node asks for
/// the bus.
class Wire : public Outbox<can::Frame, 256> {
public:
    using Signals = can::NodeSignals<carpet::can_signals>;
    using Emergencies = can::NodeSignals<emergencies>;

    Signals signals;
    Emergencies emergency;

    void send(Signals::Sent frame, Time due) noexcept TAPPET_REALTIME { push(signals.encode(frame, due)); }
    void send_emergency(Emergencies::Sent frame, Time due) noexcept TAPPET_REALTIME {
        push(emergency.encode(frame, due));
    }
    [[nodiscard]] const Digest& log() const noexcept TAPPET_REALTIME { return log_; }

    /// Either way.
    static void note(const can::Frame& frame, Time at, Digest& log) noexcept TAPPET_REALTIME {
        log.add(to_ns(at));
        log.add((std::uint64_t{frame.id} << 8) | frame.length);
        log.add(std::bit_cast<std::uint64_t>(frame.data));
    }

private:
    void push(const can::Frame& frame) noexcept TAPPET_REALTIME {
        note(frame, frame.stamp, log_);
        Outbox::push(frame);
    }
    Digest log_;
};

} // namespace tappet::loom
