// Checks of the uses rows: every call of a component reaches a method or a command of the same signature,
// from a permitted activity. Also checks the components that see the machine.
#pragma once

#include "kernel/machine/check/components.hpp"
#include "kernel/script/room.hpp"

namespace tappet::checks {

/// Stack of the activity that compiles loaded scripts: the compiler's need plus that of its callers.
inline constexpr std::size_t compiling_stack_bytes = script_stack_bytes + 64 * 1024;

/// Checks the component that executes lines of the script language: it compiles them, and has a mailbox of
/// its own into each engine.
constexpr Sentence check_interpreter(const MachineView& m, const TableIndexView& r) {
    std::size_t first = nowhere;
    for (std::size_t c = 0; c < m.components.size(); ++c) {
        const ComponentRow& row = m.components[c];
        if (row.type->lines == nullptr) continue;
        if (first != nowhere)
            return of_component(row.name, " executes lines as \"", m.components[first].name,
                                "\" does already; remove one of them");
        first = c;
        const ActivityRow& activity = m.activities[r.activity[c]];
        if (activity.stack_bytes() < compiling_stack_bytes)
            return of_component(row.name, " compiles lines in activity \"", activity.name,
                                "\", whose stack of ", activity.stack_bytes(), " bytes is under ",
                                compiling_stack_bytes, "; enlarge its stack(...)");
        if (m.components.size() > max_line_components)
            return of_component(row.name, " executes lines that name at most ", max_line_components,
                                " components, and the machine has ", m.components.size(), "; leave it out");
        if (m.activities.size() == max_activities)
            return of_component(row.name, " needs a mailbox to each engine, but ", max_activities,
                                " activities use all mailboxes; merge two activities");
    }
    return {};
}

/// Checks the components that see the machine. They share one mailbox into each engine, which has one sending
/// thread; and their work for an outside user must not delay a deadline.
constexpr Sentence check_observers(const MachineView& m, const TableIndexView& r) {
    std::size_t first = nowhere;
    for (std::size_t c = 0; c < m.components.size(); ++c) {
        if (!m.components[c].type->sees_machine) continue;
        const ActivityRow& activity = m.activities[r.activity[c]];
        if (activity.real_time)
            return of_component(m.components[c].name, " sees the machine, but its activity \"", activity.name,
                                "\" is real-time; run it in an activity that is not_real_time");
        if (first == nowhere) first = c;
        if (r.activity[c] != r.activity[first])
            return of_component(m.components[c].name, " sees the machine from activity \"", activity.name,
                                "\", but \"", m.components[first].name, "\" does so from activity \"",
                                m.activities[r.activity[first]].name, "\"; run both in one activity");
    }
    return {};
}

template <class... Pieces>
constexpr Sentence of_use(const ReactionRow& row, const Pieces&... fault) {
    return Sentence{"use \"", row.event, "\" -> \"", row.target.operation, "\"", fault...};
}

/// Finds both ends of a uses row. The kind of each end, as a message names it, follows from the kind of the
/// other.
constexpr Sentence resolve_use(const MachineView& m, const TableIndexView& r, const ReactionRow& row,
                               Link& link) {
    const auto kind_of = [&m](End end) {
        return end.component == nowhere ? FacetKind::input : facet_at(m, end).kind;
    };
    static_cast<void>(resolve(m, r.by_name, row.event, FacetKind::method_call, link.from));
    const FacetKind operation =
        kind_of(link.from) == FacetKind::command_call ? FacetKind::command : FacetKind::method;
    if (Sentence fault = resolve(m, r.by_name, row.target.operation, operation, link.to); !fault.empty())
        return of_use(row, ": ", fault);
    const FacetKind requester =
        kind_of(link.to) == FacetKind::command ? FacetKind::command_call : FacetKind::method_call;
    if (Sentence fault = resolve(m, r.by_name, row.event, requester, link.from); !fault.empty())
        return of_use(row, ": ", fault);
    return {};
}

constexpr bool is_call(FacetKind kind) noexcept {
    return kind == FacetKind::method_call || kind == FacetKind::command_call;
}

constexpr Sentence check_use_kinds(const ReactionRow& row, const Facet& from, const Facet& to) {
    const bool to_operation = to.kind == FacetKind::method || to.kind == FacetKind::command;
    if ((from.kind == FacetKind::method || from.kind == FacetKind::command) && is_call(to.kind))
        return of_use(row, " runs from ", to_text(from.kind), " to ", to_text(to.kind), "; exchange the two");
    if (!is_call(from.kind))
        return of_use(row, ": \"", row.event, "\" is ", to_text(from.kind),
                      ", not a method call or a command call; name one of these first");
    if (to.kind == FacetKind::operation)
        return of_use(row, ": \"", row.target.operation,
                      "\" is an operation, which only an event runs; declare it a method or a command");
    if (!to_operation)
        return of_use(row, ": \"", row.target.operation, "\" is ", to_text(to.kind),
                      ", not a method or a command; name one of these second");
    if (from.kind == FacetKind::method_call && to.kind == FacetKind::command)
        return of_use(row, ": a command is sent, not called; make \"", row.event, "\" a CommandCall");
    if (from.kind == FacetKind::command_call && to.kind == FacetKind::method)
        return of_use(row, ": a method is called, not sent; make \"", row.event, "\" a MethodCall");
    if (from.type != to.type)
        return of_use(row, ": the call gives (", from.type->name, ") but the ",
                      to.kind == FacetKind::method ? "method" : "command", " takes (", to.type->name,
                      "); give both the same arguments");
    if (from.kind == FacetKind::method_call && from.method_call->result != to.method->result)
        return of_use(row, ": the call and the method have different results; give both the same");
    return {};
}

/// Checks that no command that may block runs in an activity with a deadline (thesis 4.5.2).
constexpr Sentence check_blocking_commands(const MachineView& m, const TableIndexView& r) {
    for (std::size_t c = 0; c < m.components.size(); ++c)
        for (const Facet& facet : m.components[c].type->facets)
            if (facet.may_block && facet.kind == FacetKind::command && m.activities[r.activity[c]].real_time)
                return of_component(m.components[c].name, ": its command \"", facet.name,
                                    "\" may block, but its activity \"", m.activities[r.activity[c]].name,
                                    "\" is real-time; run it in an activity that is not_real_time");
    return {};
}

constexpr Sentence check_sent_by(const MachineView& m, const TableIndexView& r, const ReactionRow& row,
                                 const Link& link) {
    if (row.sent_by.empty()) return {};
    if (facet_at(m, link.from).kind != FacetKind::command_call)
        return of_use(row, ": sent_by(\"", row.sent_by, "\") is for commands only; remove it");
    const std::size_t sender = find_component(m, r.by_name, row.sent_by);
    if (sender == nowhere) return of_use(row, ": in sent_by(...), ", unknown_component(m, row.sent_by));
    if (sender == link.from.component)
        return of_use(row, ": sent_by(...) names the component that has the command; remove it");
    return {};
}

/// Checks each uses row; fills its ends.
constexpr Sentence check_uses(const MachineView& m, TableIndexView r) {
    if (Sentence fault = check_blocking_commands(m, r); !fault.empty()) return fault;
    for (std::size_t i = 0; i < m.reactions.size(); ++i) {
        const ReactionRow& row = m.reactions[i];
        if (row.kind != ReactionKind::uses) continue;
        Link& link = r.reactions[i];
        link = {};
        if (Sentence fault = resolve_use(m, r, row, link); !fault.empty()) return fault;
        const Facet& to = facet_at(m, link.to);
        if (Sentence fault = check_use_kinds(row, facet_at(m, link.from), to); !fault.empty()) return fault;
        const std::size_t caller = r.activity[link.from.component];
        const std::size_t receiver = r.activity[link.to.component];
        if (to.kind == FacetKind::method && caller != receiver && !to.any_thread)
            return of_use(row, ": the call would run \"", row.target.operation, "\" of activity \"",
                          m.activities[receiver].name, "\" in activity \"", m.activities[caller].name,
                          "\"; declare the method any_thread if it is safe there, or make it a command");
        if (to.kind == FacetKind::method && to.may_block && m.activities[caller].real_time)
            return of_use(
                row, ": the method may block, but activity \"", m.activities[caller].name,
                "\" of its caller is real-time; make it a command, or call it from an activity that "
                "is not_real_time");
        if (Sentence fault = check_sent_by(m, r, row, link); !fault.empty()) return fault;
        for (std::size_t j = 0; j < i; ++j) {
            if (m.reactions[j].kind != ReactionKind::uses || r.reactions[j].from != link.from) continue;
            if (r.reactions[j].to == link.to)
                return of_use(row, " appears twice in reactions(...), rows ", j + 1, " and ", i + 1,
                              "; remove one");
            if (to.kind == FacetKind::method && take_turns(m, r.reactions[j].to.component, link.to.component))
                continue;
            return of_use(row, ": row ", j + 1, " already connects \"", row.event, "\" to \"",
                          m.reactions[j].target.operation,
                          "\"; a call has one target: remove a row, or give \"",
                          m.components[link.from.component].name, "\" a second call");
        }
    }
    const auto must_reach = [](const Facet& facet) { return facet.required && is_call(facet.kind); };
    for (std::size_t c = 0; c < m.components.size(); ++c) {
        if (!has_facet(m.components[c].type, must_reach)) continue;
        const auto& facets = m.components[c].type->facets;
        for (std::size_t f = 0; f < facets.size(); ++f) {
            if (!must_reach(facets[f])) continue;
            bool connected = false;
            for (std::size_t i = 0; i < m.reactions.size() && !connected; ++i)
                connected = m.reactions[i].kind == ReactionKind::uses && r.reactions[i].from == End{c, f};
            if (!connected)
                return of_component(m.components[c].name, ": nothing is connected to its ",
                                    facets[f].kind == FacetKind::method_call ? "method call \""
                                                                             : "command call \"",
                                    facets[f].name, "\"; add uses(\"", m.components[c].name, ".",
                                    facets[f].name, "\", \"...\") to reactions(...), or declare it optional");
        }
    }
    return {};
}

} // namespace tappet::checks
