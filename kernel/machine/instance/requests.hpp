// What a component that sees the machine (`sees_machine = true`: the browser's service) asks of the engines
// of others: calls between two of their steps, commands, methods, and changes of a slot.
#pragma once

#include "kernel/machine/instance/placed.hpp"

#include <cstddef>
#include <span>

namespace tappet {

/// From the activity of the component that sees the machine only. Wait-free.
class MachineRequests {
public:
    explicit MachineRequests(PlacedMachine& placed) noexcept : placed_{placed}, machine_{placed.machine()} {}

    /// Runs a call in the engine of an activity, between two of its steps; `message.id` is the part it is
    /// timed as. False, and the receiver did not get it: of `requests_waiting` places so few are free that
    /// they are kept for those who are more than `role`. Real-time.
    [[nodiscard]] bool post(std::size_t activity, const Message& message, Role role = Role::engineer) noexcept
        TAPPET_REALTIME;
    /// Lets the slot carry out the change that was asked of it in its engine. False: as for post().
    /// Real-time.
    [[nodiscard]] bool post_change(BehaviourSlot& slot) noexcept TAPPET_REALTIME;

    /// Aims a command slot at a command of the table: set its packed arguments in `values`, which has room
    /// for the command's value_bytes() and outlives the slot, then send() it and read the packed results
    /// after the arguments when it is done. False: the facet is no command, the slot is on its way, or
    /// `values` are too small. At most `requests_waiting` are at work in one engine: one more is rejected.
    [[nodiscard]] bool bind_command(End to, CommandSlot& slot, std::span<std::byte> values) noexcept;
    /// Runs a method of the table in the engine of its component: packed arguments in `values`, the packed
    /// result after them when the request is done(). False: the facet is no method, the request is not done
    /// yet, `values` are too small, or too many requests wait.
    [[nodiscard]] bool request_method(End to, MethodRequest& request, std::span<std::byte> values) noexcept;

    /// Where a command slot is sent to by a row of the table, or of a behaviour, whose sender runs in
    /// `sender`; for start-up and for loading.
    [[nodiscard]] CommandSlot::Route command_route(End to, std::size_t sender) noexcept;

    /// Where a command slot of a line that somebody typed is sent to, whichever activity the line runs in;
    /// for the component that executes lines.
    [[nodiscard]] CommandSlot::Route line_route(End to) noexcept;

private:
    [[nodiscard]] CommandSlot::Route route_to(End to) noexcept;

    PlacedMachine& placed_;
    const AcceptedMachine& machine_;
};

} // namespace tappet
