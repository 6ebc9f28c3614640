// What the drive makes of its commands, of silence and of faults.
#include "apps/carpet_loom/plant/drive.hpp"

namespace tappet::loom {
namespace {

constexpr Duration command_timeout = std::chrono::microseconds{wires::drive_command_timeout_us};

} // namespace

std::uint16_t Drive::statusword() const noexcept TAPPET_REALTIME {
    unsigned word = drive_.statusword();
    if (state() != DriveState::not_ready) word |= 0x0010u; // voltage enabled: the mains are always there
    if (node_.operational()) word |= 0x0200u;              // remote
    if (at_target_ && drive_.is_enabled()) word |= 0x0400u;
    if (at_limit_) word |= 0x0800u;
    return static_cast<std::uint16_t>(word);
}

void Drive::refuse(Time now, Wire& wire) const noexcept TAPPET_REALTIME {
    if (node_.alive() && node_.operational()) send_emergency(wires::emergency_code::wrong_length, now, wire);
}

void Drive::command(Time now, Wire& wire) noexcept TAPPET_REALTIME {
    if (!node_.alive() || !node_.operational()) return;
    last_command_ = now;
    target_ = static_cast<std::int32_t>(wire.signals.integer(names_.target));
    const bool was_faulty = state() == DriveState::fault;
    drive_.control(static_cast<std::uint16_t>(wire.signals.integer(names_.controlword)));
    if (was_faulty && state() != DriveState::fault)
        send_emergency(wires::emergency_code::error_reset, now, wire);
}

void Drive::supervise(bool standing, bool at_target, bool at_limit, Time now, Wire& wire) noexcept
    TAPPET_REALTIME {
    at_target_ = at_target;
    at_limit_ = at_limit;
    const bool energised = drive_.is_enabled() || state() == DriveState::switched_on;
    if (energised && now - last_command_ > command_timeout)
        trip(wires::emergency_code::command_lost, now, wire);
    if (state() != DriveState::not_ready || node_.alive()) drive_.settle(standing);
}

void Drive::trip(std::uint16_t code, Time now, Wire& wire) noexcept TAPPET_REALTIME {
    if (!drive_.trip()) return;
    ++faults_;
    send_emergency(code, now, wire);
}

void Drive::restart() noexcept TAPPET_REALTIME {
    drive_ = {};
    target_ = 0;
}

void Drive::send_status(double actual_rpm, Time due, Wire& wire) const noexcept TAPPET_REALTIME {
    wire.signals.set_integer(names_.statusword, statusword());
    wire.signals.set(names_.velocity, actual_rpm);
    wire.send(names_.status, due);
}

void Drive::send_emergency(std::uint16_t code, Time now, Wire& wire) const noexcept TAPPET_REALTIME {
    if (!node_.alive()) return;
    // Error register (1001h): bit 0 generic, bit 4 communication; both clear when all errors are gone.
    const unsigned reg = code == 0 ? 0x00u : (code & 0xF000u) == 0x8000u ? 0x11u : 0x01u;
    wire.emergency.set_integer(names_.code, code);
    wire.emergency.set_integer(names_.error_register, reg);
    wire.send_emergency(names_.emergency, now);
}

} // namespace tappet::loom
