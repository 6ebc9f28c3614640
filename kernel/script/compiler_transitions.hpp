// Transitions of a script's state machines: conditions, events with their arguments, times, branches.
#pragma once

#include "kernel/script/compiler_machines.hpp"

namespace tappet::script_detail {

constexpr void Machines::parse_transitions(std::uint16_t state) {
    advance();
    need(Sign::open_brace, "\"{\"");
    while (ok() && !is(Sign::close_brace)) {
        const Token at = token_;
        if (take(Sign::semicolon)) continue;
        if (is(Sign::k_if) || is(Sign::k_select) || is(Sign::k_after) || is(Sign::open_brace))
            parse_transition(at, state, false);
        else if (take(Sign::k_transition))
            parse_transition(at, state, true);
        else
            fail_expected("if, select, after or transition");
    }
    need(Sign::close_brace, "\"}\"");
}

constexpr void Machines::parse_transition(const Token& at, std::uint16_t state, bool may_hear) {
    TransitionRow row;
    row.from = states_[state].name;
    row.line = at.line;
    row.column = at.column;
    std::string_view label = "transition";
    if (take(Sign::k_after)) {
        const Token where = token_;
        const Operand time = parse_known(script_duration, "the time of a transition");
        if (ok() && (!time.literal || time.type != script_duration))
            fail_type(where, time.type, "a duration such as 5s", "");
        row.timed = true;
        row.after = Duration{time.integer};
        ++timers_;
    } else if (may_hear && !is(Sign::k_if) && !is(Sign::k_select) && !is(Sign::open_brace)) {
        parse_event(row);
        label = row.event;
    }
    if (take(Sign::k_if)) {
        begin_action();
        const std::uint16_t first = first_instruction_;
        const Token where = token_;
        const Operand value = parse_condition();
        row.guard = ConditionRef{make_condition(where, first, value)};
        if (take(Sign::k_because)) {
            const Token reason = token_;
            if (need(Sign::text, "the reason that is shown when the condition does not hold, in quotes"))
                row.refusal.text = keep({reason.text});
            if (ok() && row.refusal.text.empty())
                return fail(reason,
                            {"the reason is empty; say what is missing when the condition does not hold"});
        }
        static_cast<void>(take(Sign::k_then));
    }
    const auto number = static_cast<std::uint16_t>(transitions_.count());
    row.then = parse_branch_program(row.from, label);
    const bool selects = parse_select(row, number, false);
    if (!selects && !row.on_event) return fail_expected("\"select\" and the state that is entered");
    if (!ok()) return;
    if (is(Sign::k_else)) {
        const Token else_at = token_;
        advance();
        if (row.guard.empty())
            return fail(else_at, {"found \"else\", but the transition has no condition that could be false"});
        if (!row.on_event) { // the next condition transition, which is always open
            add(transitions_, row, "transitions");
            TransitionRow other;
            other.from = row.from;
            other.timed = row.timed; // else: when the time has passed and the condition does not hold
            other.after = row.after;
            other.line = else_at.line;
            other.column = else_at.column;
            other.then = parse_branch_program(row.from, label);
            if (!parse_select(other, static_cast<std::uint16_t>(number + 1), false))
                return fail_expected("\"select\" and the state that is entered");
            add(transitions_, other, "transitions");
            return;
        }
        row.has_otherwise = true;
        row.otherwise = parse_branch_program(row.from, label);
        static_cast<void>(parse_select(row, number, true));
    }
    static_cast<void>(take(Sign::semicolon));
    add(transitions_, row, "transitions");
}

constexpr ProgramRef Machines::parse_branch_program(std::string_view state, std::string_view label) {
    if (!take(Sign::open_brace)) return {};
    const ProgramIndex program = parse_program({state, ".", label});
    need(Sign::close_brace, "\"}\"");
    return ok() && program != no_program ? ProgramRef{program} : ProgramRef{};
}

constexpr bool Machines::parse_select(TransitionRow& row, std::uint16_t number, bool otherwise) {
    if (!take(Sign::k_select)) return false;
    Token target = need_name("the state that is entered");
    EntryKind enters = EntryKind::initial;
    const bool deep = target.text == "deep" && is(Sign::name);
    if (deep) target = need_name("history");
    if ((target.text == "history" && is(Sign::open_round)) || deep) {
        enters = deep ? EntryKind::deep_history : EntryKind::shallow_history;
        need(Sign::open_round, "\"(\"");
        target = need_name("the composite state whose history is entered");
        need(Sign::close_round, "\")\"");
    }
    if (!ok()) return false;
    (otherwise ? row.otherwise_to : row.to) = target.text;
    if (!otherwise)
        row.enters = enters;
    else if (enters != EntryKind::initial)
        fail(target, {"the else branch enters a state itself and not its history"});
    if (unresolved_used_ < unresolved_.size())
        unresolved_[unresolved_used_++] = {number, otherwise, target.line, target.column};
    if (take(Sign::k_because)) {
        const Token reason = token_;
        if (need(Sign::text, "the reason, in quotes")) row.because = keep({reason.text});
    }
    static_cast<void>(take(Sign::semicolon));
    return true;
}

constexpr void Machines::parse_event(TransitionRow& row) {
    const Token name = need_word("the name of an event, if, select or after");
    if (!ok()) return;
    std::uint16_t component = 0;
    Token event_name = name;
    if (is(Sign::dot)) {
        component = find_component(name.text);
        if (component == none) {
            Nearest nearest{name.text};
            for (const Reachable& each : reach_.components) nearest.consider(each.name);
            return fail_unknown(name, "component", nearest, "");
        }
        advance();
        event_name = need_word("the name of an event");
    }
    const auto all = facets(component);
    while (ok() && is(Sign::dot) && is_begun(all, event_name.text, 0, all.size()))
        static_cast<void>(extend(event_name));
    const std::uint16_t number = ok() ? find_facet(component, event_name.text) : none;
    if (!ok()) return;
    if (number == none || facet_of(component, number).kind != FacetKind::event) {
        Nearest nearest{event_name.text};
        for (const Facet& each : facets(component))
            if (each.kind == FacetKind::event) nearest.consider(each.name);
        return fail_unknown(event_name, "event", nearest,
                            component == 0 ? " in the component itself" : " in that component");
    }
    const Facet& facet = facet_of(component, number);
    check_reach(event_name, component, facet.name, reach_.events, "events");
    row.on_event = true;
    for (std::size_t i = transitions_.count(); row.event.empty() && i-- > 0;) // stores the characters once
        if (transitions_[i].on_event && is_event(transitions_[i].event, component, facet.name))
            row.event = transitions_[i].event;
    if (row.event.empty())
        row.event =
            component == 0 ? keep({facet.name}) : keep({reach_.components[component].name, ".", facet.name});
    if (take(Sign::open_round)) parse_captures(row, event_name, facet.type->elements);
}

constexpr void Machines::parse_captures(TransitionRow& row, const Token& event,
                                        std::span<const TypeId> types) {
    row.first_capture = static_cast<std::uint16_t>(captures_.count());
    std::size_t from = 0, i = 0;
    for (; ok() && !is(Sign::close_round); ++i) {
        const Token name = need_name("the variable that receives this argument");
        if (!ok()) return;
        if (i == types.size())
            return fail(name, {"event \"", quoted(event.text), "\" has ", digits(types.size()),
                               " arguments; leave out what is more"});
        const Symbol* const symbol = find_symbol(name);
        if (symbol == nullptr || symbol->kind != SymbolKind::variable || symbol->fixed) {
            Nearest nearest{name.text};
            for (std::size_t s = 0; s < symbols_used_; ++s)
                if (symbols_[s].kind == SymbolKind::variable) nearest.consider(symbols_[s].name);
            return fail_unknown(name, "variable", nearest, "; declare it with var");
        }
        CaptureRow capture;
        capture.from = static_cast<std::uint16_t>(from);
        capture.size = static_cast<std::uint16_t>(types[i]->size);
        if (symbol->operand.type == types[i]) {
            capture.raw = symbol->operand.at;
        } else {
            begin_action();
            capture.raw = place_in(Region::arguments, types[i]->size);
            capture.first = instruction_count();
            Operand value = reckoned(name, at_place(types[i], capture.raw));
            store(name, value, symbol->operand.type, symbol->operand.at, " of the event's argument");
            capture.count = static_cast<std::uint16_t>(instruction_count() - capture.first);
        }
        add(captures_, capture, "captured arguments");
        ++row.captures;
        from += types[i]->size;
        if (!is(Sign::close_round)) need(Sign::comma, "\",\" or \")\"");
    }
    need(Sign::close_round, "\")\"");
}

} // namespace tappet::script_detail
