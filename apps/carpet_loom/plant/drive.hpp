// A velocity drive of the loom: a CiA 402 automaton that supervises itself, its process data and its
// emergency messages. Not its motor.
#pragma once

#include "apps/carpet_loom/plant/node.hpp"
#include "drivers/canopen/simulated_drive.hpp"

namespace tappet::loom {

using canopen::DriveState;
using Power = canopen::SimulatedDrive::Power;

/// Its frames and signals.
struct DriveNames {
    Wire::Signals::Sent status;
    Wire::Signals::SentSignal statusword, velocity;
    Wire::Signals::Received command;
    Wire::Signals::ReceivedSignal controlword, target;
    Wire::Emergencies::Sent emergency;
    Wire::Emergencies::SentSignal code, error_register;
};
inline constexpr DriveNames main_drive_names{"main_drive",
                                             "main_drive.statusword",
                                             "main_drive.velocity",
                                             "main_drive_command",
                                             "main_drive_command.controlword",
                                             "main_drive_command.velocity",
                                             "main_drive",
                                             "main_drive.code",
                                             "main_drive.register"};
inline constexpr DriveNames let_off_names{"let_off",
                                          "let_off.statusword",
                                          "let_off.velocity",
                                          "let_off_command",
                                          "let_off_command.controlword",
                                          "let_off_command.velocity",
                                          "let_off",
                                          "let_off.code",
                                          "let_off.register"};

class Drive {
public:
    /// `names` outlives it.
    Drive(std::uint8_t id, const DriveNames& names, Random& random) noexcept TAPPET_REALTIME
        : node_(id, wires::drive_status_period_us, random),
          names_(names) {}

    [[nodiscard]] Node& node() noexcept TAPPET_REALTIME { return node_; }
    [[nodiscard]] const Node& node() const noexcept TAPPET_REALTIME { return node_; }
    [[nodiscard]] DriveState state() const noexcept TAPPET_REALTIME { return drive_.state(); }
    [[nodiscard]] Power power() const noexcept TAPPET_REALTIME {
        return node_.alive() ? drive_.power() : Power::off;
    }
    [[nodiscard]] std::uint16_t statusword() const noexcept TAPPET_REALTIME;
    /// In the unit of the wire.
    [[nodiscard]] std::int32_t target() const noexcept TAPPET_REALTIME { return target_; }
    [[nodiscard]] std::uint64_t faults() const noexcept TAPPET_REALTIME { return faults_; }

    [[nodiscard]] bool hears(std::size_t row) const noexcept TAPPET_REALTIME {
        return row == names_.command.index;
    }
    /// Its command has come, see `wire`.
    void command(Time now, Wire& wire) noexcept TAPPET_REALTIME;
    /// One of another length is answered with an emergency message and otherwise ignored.
    void refuse(Time now, Wire& wire) const noexcept TAPPET_REALTIME;
    /// Supervision and automatic transitions; the motor stands or not, follows its target or not.
    void supervise(bool standing, bool at_target, bool at_limit, Time now, Wire& wire) noexcept
        TAPPET_REALTIME;
    void trip(std::uint16_t code, Time now, Wire& wire) noexcept TAPPET_REALTIME;
    /// Power-up or NMT reset node.
    void restart() noexcept TAPPET_REALTIME;
    void send_status(double actual_rpm, Time due, Wire& wire) const noexcept TAPPET_REALTIME;

private:
    void send_emergency(std::uint16_t code, Time now, Wire& wire) const noexcept TAPPET_REALTIME;

    Node node_;
    const DriveNames& names_;
    canopen::SimulatedDrive drive_;
    std::int32_t target_ = 0;
    Time last_command_{};
    bool at_target_ = false;
    bool at_limit_ = false;
    std::uint64_t faults_ = 0;
};

} // namespace tappet::loom
