// The drive's reaction to commands, to silence and to faults.
#include "apps/carpet_loom/plant/drive.hpp"

#include "apps/carpet_loom/plant/shapes.hpp"

namespace tappet::loom {
namespace {

constexpr std::int64_t profile_velocity = 3;

} // namespace

std::uint16_t Drive::statusword() const noexcept TAPPET_REALTIME {
    unsigned word = drive_.statusword();
    if (state() != DriveState::not_ready) word |= 0x0010u; // voltage enabled: the mains are always on
    if (node_.operational()) word |= 0x0200u;              // remote
    if (at_target_ && drive_.is_enabled()) word |= 0x0400u;
    if (at_limit_) word |= 0x0800u;
    return static_cast<std::uint16_t>(word);
}

void Drive::command(Time now, Wire& wire) noexcept TAPPET_REALTIME {
    last_command_ = now;
    const bool in_mode = node_.get_signed(0x6060) == profile_velocity;
    target_ = in_mode ? static_cast<std::int32_t>(node_.get_signed(0x60FF)) : 0;
    const bool was_faulty = state() == DriveState::fault;
    drive_.control(static_cast<std::uint16_t>(node_.get(0x6040)));
    if (was_faulty && state() != DriveState::fault)
        send_emergency(canopen::emergency_code::error_reset, now, wire);
}

void Drive::supervise(bool standing, bool at_target, bool at_limit, Time now, Wire& wire) noexcept
    TAPPET_REALTIME {
    at_target_ = at_target;
    at_limit_ = at_limit;
    const bool energised = drive_.is_enabled() || state() == DriveState::switched_on;
    if (energised && now - last_command_ > wires::drive_command_timeout)
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

void Drive::send_status(double actual_rpm, Wire& wire) noexcept TAPPET_REALTIME {
    node_.set(0x6041, statusword());
    node_.set(0x6061, node_.get(0x6060));
    node_.set(0x606C, static_cast<std::uint64_t>(round_to_int(actual_rpm * velocity_per_rpm_)));
    node_.send_due(wire);
}

void Drive::send_emergency(std::uint16_t code, Time now, Wire& wire) noexcept TAPPET_REALTIME {
    // Error register (1001h): bit 0 generic, bit 4 communication; both clear when all errors are gone.
    const unsigned reg = code == 0 ? 0x00u : (code & 0xF000u) == 0x8000u ? 0x11u : 0x01u;
    node_.set(0x603F, code);
    node_.send_emergency(code, static_cast<std::uint8_t>(reg), now, wire);
}

} // namespace tappet::loom
