// The instructions with which a program acts on a component's facet (thesis 5.1.4: the factories of a peer's
// interface).
#pragma once

#include "kernel/program/primitives_facet.hpp"
#include "kernel/program/primitives_value.hpp"

namespace tappet {

/// An instruction; its `to`, `a` and `link` are set later. Null run: the facet is not of that kind.
struct FacetAction {
    Instruction instruction{};
    TypeId type = nullptr; ///< type of the value in `to` or in `a`, whichever is used; a stored type
    constexpr explicit operator bool() const noexcept { return instruction.run != nullptr; }
};

namespace detail {

constexpr FacetAction facet_action(bool fits, Primitive run, const Facet& facet, TypeId type) noexcept {
    if (!fits) return {};
    return {
        {.run = run, .facet = &facet, .size = static_cast<std::uint16_t>(type != nullptr ? type->size : 0)},
        type};
}
constexpr FacetAction facet_action(FacetKind kind, Primitive run, const Facet& facet, TypeId type) noexcept {
    return facet_action(facet.kind == kind, run, facet, type);
}

} // namespace detail

/// `to` = the value of a property, an input or an output.
constexpr FacetAction find_read(const Facet& facet) noexcept {
    const bool port = facet.kind == FacetKind::input || facet.kind == FacetKind::output;
    return detail::facet_action(port || facet.kind == FacetKind::property,
                                facet.kind == FacetKind::input    ? &primitive::read_input
                                : facet.kind == FacetKind::output ? &primitive::read_output
                                                                  : &primitive::read_property,
                                facet, facet.type);
}
/// The same for readers other than the component: an input's fresh value stays fresh for the component.
constexpr FacetAction find_look(const Facet& facet) noexcept {
    FacetAction action = find_read(facet);
    if (facet.kind == FacetKind::input) action.instruction.run = &primitive::look_at_input;
    return action;
}
/// Writes the value `a` to a property, an output or a buffered output. The action fails when the value is out
/// of range, the component does not consent, or the buffer is full.
constexpr FacetAction find_write(const Facet& facet) noexcept {
    return detail::facet_action(facet.kind == FacetKind::output || facet.kind == FacetKind::property ||
                                    facet.kind == FacetKind::buffer_output,
                                facet.kind == FacetKind::output          ? &primitive::write_output
                                : facet.kind == FacetKind::buffer_output ? &primitive::push_all
                                                                         : &primitive::write_property,
                                facet, facet.type);
}
/// `to`: a bool, whether an input is valid.
constexpr FacetAction input_valid(const Facet& facet) noexcept {
    return detail::facet_action(FacetKind::input, &primitive::input_valid, facet, type_id<bool>);
}
constexpr FacetAction input_fresh(const Facet& facet) noexcept {
    return detail::facet_action(FacetKind::input, &primitive::input_fresh, facet, type_id<bool>);
}
/// `to`: a Duration, the age of an input or an output.
constexpr FacetAction port_age(const Facet& facet) noexcept {
    return detail::facet_action(facet.kind == FacetKind::input || facet.kind == FacetKind::output,
                                &primitive::port_age, facet, type_id<Duration>);
}

/// Writes `a` to a buffered output; `to`: a bool, whether all readers had room. type: of the value.
constexpr FacetAction push_buffer(const Facet& facet) noexcept {
    return detail::facet_action(FacetKind::buffer_output, &primitive::push_buffer, facet, facet.type);
}
/// `to` = the oldest value of a buffered input; fails the action when the buffer is empty.
constexpr FacetAction pop_buffer(const Facet& facet) noexcept {
    return detail::facet_action(FacetKind::buffer_input, &primitive::pop_buffer, facet, facet.type);
}
/// As pop_buffer, but waits while the buffer is empty. The whole node is executed again, so put it first in
/// its node.
constexpr FacetAction wait_buffer(const Facet& facet) noexcept {
    return detail::facet_action(FacetKind::buffer_input, &primitive::wait_buffer, facet, facet.type);
}
/// `to`: a bool.
constexpr FacetAction buffer_empty(const Facet& facet) noexcept {
    return detail::facet_action(FacetKind::buffer_input, &primitive::buffer_empty, facet, type_id<bool>);
}

// Below, `a` holds the arguments packed one after the other without gaps, each in its C++ type;
// facet.type->elements lists them, facet.command->arguments->elements those of a command.

constexpr FacetAction emit_event(const Facet& facet) noexcept {
    return detail::facet_action(FacetKind::event, &primitive::emit_event, facet, nullptr);
}
constexpr FacetAction call_operation(const Facet& facet) noexcept {
    return detail::facet_action(FacetKind::operation, &primitive::call_operation, facet, nullptr);
}
/// `to`: the result, of `type`; null type: no result.
constexpr FacetAction call_method(const Facet& facet) noexcept {
    if (facet.kind != FacetKind::method) return {};
    return detail::facet_action(true, &primitive::call_method, facet,
                                facet.method->result_bytes == 0 ? nullptr : facet.method->result);
}
/// Calls a method as a statement: false as its result fails the action (thesis 5.1.1); any other result is
/// written to `to` and ignored.
constexpr FacetAction do_method(const Facet& facet) noexcept {
    FacetAction action = call_method(facet);
    if (action && action.type == type_id<bool>) action.instruction.run = &primitive::call_checked;
    return action;
}

/// Starts a command of the own component, in this call. `to`: argument and result bytes, kept while the
/// program runs; earlier instructions wrote the arguments there.
constexpr FacetAction begin_command(const Facet& facet) noexcept {
    return detail::facet_action(FacetKind::command, &primitive::begin_command, facet, nullptr);
}
/// `to`: a bool, done; `a`: the bytes of begin_command, whose results are valid then.
constexpr FacetAction command_progress(const Facet& facet) noexcept {
    return detail::facet_action(FacetKind::command, &primitive::command_progress, facet, type_id<bool>);
}
/// Sends a command of another activity with the arguments `a`; tries again while an earlier one is pending.
/// The link needs a slot.
constexpr FacetAction send_command(const Facet& facet) noexcept {
    return detail::facet_action(FacetKind::command, &primitive::send_command, facet, nullptr);
}
/// `to`: a bool, done; a rejected or failed command fails the condition.
constexpr FacetAction command_ended(const Facet& facet) noexcept {
    return detail::facet_action(FacetKind::command, &primitive::command_ended, facet, type_id<bool>);
}
/// `to`: the packed results, facet.command->results, of a command that is done.
constexpr FacetAction command_results(const Facet& facet) noexcept {
    return detail::facet_action(FacetKind::command, &primitive::command_results, facet, nullptr);
}

/// `to`: a Duration, the time since the node was entered.
constexpr FacetAction elapsed_time() noexcept {
    return {{.run = &primitive::elapsed, .size = sizeof(Duration)}, type_id<Duration>};
}
/// `to`: a Duration, the machine's time.
constexpr FacetAction machine_time() noexcept {
    return {{.run = &primitive::time_now, .size = sizeof(Duration)}, type_id<Duration>};
}

} // namespace tappet
