// Primitives that act on components through their facets: ports, buffers, events, methods, operations,
// commands and properties (thesis 4.4 - 4.7, 5.1.5).
#pragma once

#include "kernel/program/value_access.hpp"

namespace tappet::primitive {

inline const ProgramLink& link_of(const ProgramContext& context, const Instruction& in) noexcept
    TAPPET_REALTIME {
    return context.links[in.link];
}

// ---- data ports; values in the port's byte layout

inline ActionResult read_input(ProgramContext& context, const Instruction& in, std::byte* to,
                               const std::byte*, const std::byte*) noexcept TAPPET_REALTIME {
    static_cast<void>(in.facet->port->read(link_of(context, in).place, true, false, to));
    return ActionResult::done;
}
/// Reads the current value of an input without marking it read: it stays fresh for the component.
inline ActionResult look_at_input(ProgramContext& context, const Instruction& in, std::byte* to,
                                  const std::byte*, const std::byte*) noexcept TAPPET_REALTIME {
    static_cast<void>(in.facet->port->read(link_of(context, in).place, true, true, to));
    return ActionResult::done;
}
inline ActionResult read_output(ProgramContext& context, const Instruction& in, std::byte* to,
                                const std::byte*, const std::byte*) noexcept TAPPET_REALTIME {
    static_cast<void>(in.facet->port->read(link_of(context, in).place, false, false, to));
    return ActionResult::done;
}
inline ActionResult write_output(ProgramContext& context, const Instruction& in, std::byte*,
                                 const std::byte* a, const std::byte*) noexcept TAPPET_REALTIME {
    in.facet->port->write(link_of(context, in).place, a);
    return ActionResult::done;
}
/// Returns whether an input has a value that is not stale.
inline ActionResult input_valid(ProgramContext& context, const Instruction& in, std::byte* to,
                                const std::byte*, const std::byte*) noexcept TAPPET_REALTIME {
    const Flow flow = in.facet->port->flow(link_of(context, in).place);
    store_value(to, flow == Flow::old || flow == Flow::fresh);
    return ActionResult::done;
}
/// Returns whether an input has a value that was not read yet.
inline ActionResult input_fresh(ProgramContext& context, const Instruction& in, std::byte* to,
                                const std::byte*, const std::byte*) noexcept TAPPET_REALTIME {
    store_value(to, in.facet->port->flow(link_of(context, in).place) == Flow::fresh);
    return ActionResult::done;
}
/// Returns the age of a value; of an input without a value, the time since the machine's time began.
inline ActionResult port_age(ProgramContext& context, const Instruction& in, std::byte* to, const std::byte*,
                             const std::byte*) noexcept TAPPET_REALTIME {
    const bool is_input = in.facet->kind == FacetKind::input;
    void* const port = link_of(context, in).place;
    if (is_input) static_cast<void>(in.facet->port->flow(port)); // fetches a newer value
    const Time stamp = *in.facet->port->places(port, is_input).stamp;
    store_value(to, context.now - stamp);
    return ActionResult::done;
}

// ---- buffers

/// `to`: a bool, whether every reader had room.
inline ActionResult push_buffer(ProgramContext& context, const Instruction& in, std::byte* to,
                                const std::byte* a, const std::byte*) noexcept TAPPET_REALTIME {
    store_value(to, in.facet->buffer->push(link_of(context, in).place, a));
    return ActionResult::done;
}
/// As push_buffer; a lost value fails the action.
inline ActionResult push_all(ProgramContext& context, const Instruction& in, std::byte*, const std::byte* a,
                             const std::byte*) noexcept TAPPET_REALTIME {
    return in.facet->buffer->push(link_of(context, in).place, a) ? ActionResult::done : ActionResult::failed;
}
/// `to` = the oldest value, in place; an empty buffer fails the action.
inline ActionResult pop_buffer(ProgramContext& context, const Instruction& in, std::byte* to,
                               const std::byte*, const std::byte*) noexcept TAPPET_REALTIME {
    return in.facet->buffer->pop(link_of(context, in).place, to) ? ActionResult::done : ActionResult::failed;
}
/// As pop_buffer; an empty buffer is polled again in the next step.
inline ActionResult wait_buffer(ProgramContext& context, const Instruction& in, std::byte* to,
                                const std::byte*, const std::byte*) noexcept TAPPET_REALTIME {
    return in.facet->buffer->pop(link_of(context, in).place, to) ? ActionResult::done : ActionResult::again;
}
inline ActionResult buffer_empty(ProgramContext& context, const Instruction& in, std::byte* to,
                                 const std::byte*, const std::byte*) noexcept TAPPET_REALTIME {
    store_value(to, in.facet->buffer->empty(link_of(context, in).place));
    return ActionResult::done;
}

// ---- events, methods, operations: `a` holds the packed arguments, as the facet's type lists them. A call to
// a component that does not run fails the action.

inline ActionResult emit_event(ProgramContext& context, const Instruction& in, std::byte*, const std::byte* a,
                               const std::byte*) noexcept TAPPET_REALTIME {
    in.facet->event->emit(link_of(context, in).place, a);
    return ActionResult::done;
}
inline ActionResult call_operation(ProgramContext& context, const Instruction& in, std::byte*,
                                   const std::byte* a, const std::byte*) noexcept TAPPET_REALTIME {
    return in.facet->operation->run(*link_of(context, in).component, Entry::at_once, a)
               ? ActionResult::done
               : ActionResult::failed;
}
/// `to`: the result, if there is one.
inline ActionResult call_method(ProgramContext& context, const Instruction& in, std::byte* to,
                                const std::byte* a, const std::byte*) noexcept TAPPET_REALTIME {
    return in.facet->method->call_packed(*link_of(context, in).component, Entry::at_once, a, to)
               ? ActionResult::done
               : ActionResult::failed;
}
/// Calls a method that returns bool as a statement: false fails the action (thesis 5.1.1).
inline ActionResult call_checked(ProgramContext& context, const Instruction& in, std::byte*,
                                 const std::byte* a, const std::byte*) noexcept TAPPET_REALTIME {
    std::byte answer{};
    const bool given =
        in.facet->method->call_packed(*link_of(context, in).component, Entry::at_once, a, &answer);
    return given && answer != std::byte{0} ? ActionResult::done : ActionResult::failed;
}

// ---- commands. Those of the own component run in this call (thesis 5.1.5): `to` of the first and `a` of the
// second primitive hold the arguments followed by the results, kept while the program runs.

/// A rejected command fails the action.
inline ActionResult begin_command(ProgramContext& context, const Instruction& in, std::byte* to,
                                  const std::byte*, const std::byte*) noexcept TAPPET_REALTIME {
    return in.facet->command->begin(*link_of(context, in).component, to) ? ActionResult::done
                                                                         : ActionResult::failed;
}
/// `to`: a bool, whether it is done; a failed command fails the condition.
inline ActionResult command_progress(ProgramContext& context, const Instruction& in, std::byte* to,
                                     const std::byte* a, const std::byte*) noexcept TAPPET_REALTIME {
    // The values belong to the program, and the completion writes its results there.
    const CommandProgress progress =
        in.facet->command->ask(*link_of(context, in).component, const_cast<std::byte*>(a));
    store_value(to, progress == CommandProgress::done);
    return progress == CommandProgress::failed ? ActionResult::failed : ActionResult::done;
}
/// Sends a command to another activity: `a` holds the arguments, if any. Tries again while an earlier one is
/// pending.
inline ActionResult send_command(ProgramContext& context, const Instruction& in, std::byte*,
                                 const std::byte* a, const std::byte*) noexcept TAPPET_REALTIME {
    CommandSlot* const slot = link_of(context, in).slot;
    if (slot == nullptr || !slot->connected()) return ActionResult::failed;
    if (!slot->is_mine()) return ActionResult::again;
    const CommandOperations& command = *in.facet->command;
    if (command.argument_bytes != 0) std::memcpy(slot->values(), a, command.argument_bytes);
    std::memset(slot->values() + command.argument_bytes, 0, command.result_bytes);
    return slot->send() ? ActionResult::done : ActionResult::failed;
}
/// `to`: a bool, whether it is done; a rejected or failed command fails the condition.
inline ActionResult command_ended(ProgramContext& context, const Instruction& in, std::byte* to,
                                  const std::byte*, const std::byte*) noexcept TAPPET_REALTIME {
    const CommandState state = link_of(context, in).slot->state();
    store_value(to, state == CommandState::done);
    return state == CommandState::done || in_flight(state) ? ActionResult::done : ActionResult::failed;
}
/// `to`: the packed results of a command that is done.
inline ActionResult command_results(ProgramContext& context, const Instruction& in, std::byte* to,
                                    const std::byte*, const std::byte*) noexcept TAPPET_REALTIME {
    const CommandSlot* const slot = link_of(context, in).slot;
    if (slot->state() != CommandState::done) return ActionResult::failed;
    std::memcpy(to, slot->values() + in.facet->command->argument_bytes, in.facet->command->result_bytes);
    return ActionResult::done;
}

// ---- properties

inline ActionResult read_property(ProgramContext& context, const Instruction& in, std::byte* to,
                                  const std::byte*, const std::byte*) noexcept TAPPET_REALTIME {
    std::memcpy(to, link_of(context, in).place, in.size);
    return ActionResult::done;
}
/// Writes a property. A value that is out of range, or to which the component does not consent, fails the
/// action and changes nothing.
inline ActionResult write_property(ProgramContext& context, const Instruction& in, std::byte*,
                                   const std::byte* a, const std::byte*) noexcept TAPPET_REALTIME {
    const ProgramLink& link = link_of(context, in);
    const ProposedValue proposed{static_cast<std::byte*>(link.place), a, in.size,
                                 static_cast<std::uint32_t>(in.facet - link.type->facets.data())};
    bool taken = false;
    const bool entered = link.component->enter(Entry::always, [&](void* component) noexcept TAPPET_REALTIME {
        taken = link.type->change(component, {&proposed, 1}).empty();
    });
    return entered && taken ? ActionResult::done : ActionResult::failed;
}

} // namespace tappet::primitive
