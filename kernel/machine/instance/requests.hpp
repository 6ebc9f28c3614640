// Requests of a component that sees the machine (`sees_machine = true`: the browser's service) to the engines
// of others: calls between two of their steps, commands, methods, and changes of a slot.
#pragma once

#include "kernel/machine/instance/placed.hpp"

#include <cstddef>
#include <span>

namespace tappet {

/// Only from the activity of the component that sees the machine. Wait-free.
class MachineRequests {
public:
    explicit MachineRequests(PlacedMachine& placed) noexcept : placed_{placed}, machine_{placed.machine()} {}

    /// Runs a call in the engine of an activity, between two of its steps; `message.id` is the part that its
    /// time is charged to. Returns false when the receiver did not get it: the few free places of
    /// `requests_waiting` are reserved for roles above `role`. Real-time.
    [[nodiscard]] bool post(std::size_t activity, const Message& message, Role role = Role::engineer) noexcept
        TAPPET_REALTIME;
    /// Lets the slot carry out the requested change in its engine. Returns false like post(). Real-time.
    [[nodiscard]] bool post_change(BehaviourSlot& slot) noexcept TAPPET_REALTIME;

    /// Aims a command slot at a command of the table. Set its packed arguments in `values`, which has room
    /// for the command's value_bytes() and outlives the slot, then send() it and read the packed results
    /// after the arguments when it is done. False: the facet is no command, the slot is in progress, or
    /// `values` is too small. At most `requests_waiting` commands run in one engine: a further one is
    /// rejected.
    [[nodiscard]] bool bind_command(End to, CommandSlot& slot, std::span<std::byte> values) noexcept;
    /// Runs a method of the table in the engine of its component: packed arguments in `values`, the packed
    /// result after them when the request is done(). False: the facet is no method, the request is not done
    /// yet, `values` is too small, too many requests wait, or the method may block in a real-time activity.
    [[nodiscard]] bool request_method(End to, MethodRequest& request, std::span<std::byte> values) noexcept;

    /// Returns the route of a command slot for a row of the table, or of a behaviour, whose sender runs in
    /// activity `sender`; for start-up and for loading.
    [[nodiscard]] CommandSlot::Route command_route(End to, std::size_t sender) noexcept;

    /// Returns the route of a command slot of a typed line, whichever activity the line runs in; for the
    /// component that executes lines.
    [[nodiscard]] CommandSlot::Route line_route(End to) noexcept;

private:
    [[nodiscard]] CommandSlot::Route route_to(End to) noexcept;

    PlacedMachine& placed_;
    const AcceptedMachine& machine_;
};

} // namespace tappet
