// States of a state machine: their programs, preconditions, inner states and transitions.
#pragma once

#include "kernel/script/parse_action.hpp"

namespace tappet::script_detail {

class States {
public:
    constexpr States(Basis& basis, Expressions& expressions, Statements& statements)
        : basis_{basis}, expressions_{expressions}, statements_{statements} {}

    constexpr void begin_machine() noexcept {
        heads_ = {};
        unresolved_used_ = 0;
    }
    /// Parses "state name { ... }", inside of the state `parent` if there is one.
    constexpr void parse(std::string_view parent = {}, std::string_view region = {}) {
        if (!text_.enter()) return;
        const std::uint16_t outer_scope = run_scope_;
        const Token at = text_.token();
        StateRow row{.name = {}, .parent = parent, .region = region, .line = at.line, .column = at.column};
        for (;;) {
            if (text_.take(Sign::k_initial))
                row.initial = true;
            else if (text_.take(Sign::k_final))
                row.final = true;
            else
                break;
        }
        text_.need(Sign::k_state, "\"state\"");
        const Token name = text_.need_name("the name of the state");
        if (text_.ok() && find(name.text, name.hash) != nullptr)
            text_.fail(name, {"state \"", quoted(name.text), "\" is there twice; rename one"});
        if (out_.states.count() == max_states) text_.fail_limit("states in one machine");
        if (!text_.ok()) return;
        row.name = out_.keep({name.text});
        if (text_.take(Sign::k_in)) {
            const Token outer = text_.need_name("the name of the state around this one");
            if (text_.ok() && !parent.empty())
                text_.fail(outer, {"this state is inside of \"", parent, "\" already; leave out \"in\""});
            row.parent = outer.text;
            if (text_.take(Sign::k_region)) row.region = parse_region_name();
        }
        const std::uint16_t number = out_.add(out_.states, row, "states");
        if (!text_.ok()) return;
        add_name(number, name);
        // When a state names its enclosing state, its depth is not known yet.
        outer_[number] = row.parent == parent ? outer_scope : alone;
        run_scope_ = scope_of(number);
        if (text_.need(Sign::open_brace, "\"{\"")) parse_body(number);
        run_scope_ = outer_scope;
        text_.leave();
    }
    /// Replaces names of states by copies that outlive the text; call when all states are known.
    constexpr void resolve_names() {
        for (StateRow& row : out_.states.view()) resolve(row.parent, row.line, row.column);
        for (const Target& each : std::span{unresolved_}.first(unresolved_used_)) {
            TransitionRow& row = out_.transitions[each.transition];
            resolve(each.otherwise ? row.otherwise_to : row.to, each.line, each.column);
        }
        if (unresolved_used_ < unresolved_.size()) return;
        for (TransitionRow& row : out_.transitions.view()) {
            resolve(row.to, row.line, row.column);
            resolve(row.otherwise_to, row.line, row.column);
        }
    }

private:
    static constexpr std::uint16_t alone = 0xffff;

    constexpr std::string_view parse_region_name() {
        const Token name = text_.need_name("the name of the region");
        return text_.ok() ? out_.keep({name.text}) : std::string_view{};
    }
    /// Programs of a machine that may run at the same time: the run programs of a state and of its enclosing
    /// states, those of different regions, and the current program, whose scope is 0. Sibling states of one
    /// region are never active together and share a scope: that of the first.
    [[nodiscard]] constexpr std::uint16_t scope_of(std::uint16_t number) const noexcept {
        std::uint16_t first = number;
        if (outer_[number] != alone)
            for (first = 0;
                 outer_[first] != outer_[number] || out_.states[first].region != out_.states[number].region;)
                ++first;
        return static_cast<std::uint16_t>(first + 1);
    }
    constexpr void parse_body(std::uint16_t number) {
        std::array<Reader::Place, 8> preconditions{};
        std::size_t asked = 0;
        const std::string_view name = out_.states[number].name;
        while (text_.ok() && !text_.is(Sign::close_brace)) {
            const Token at = text_.token();
            switch (at.sign) {
            case Sign::semicolon: text_.advance(); break;
            case Sign::k_entry: parse_program(number, &StateRow::entry); break;
            case Sign::k_run: parse_program(number, &StateRow::run); break;
            case Sign::k_exit: parse_program(number, &StateRow::exit); break;
            case Sign::k_handle: parse_program(number, &StateRow::handle); break;
            case Sign::k_precondition:
                text_.advance();
                if (asked == preconditions.size()) text_.fail_limit("preconditions of one state");
                if (!text_.is(Sign::open_round)) text_.fail_expected("\"(\" and the precondition");
                if (!text_.ok()) break;
                preconditions[asked++] = text_.here();
                flow_.begin_action();
                static_cast<void>(expressions_.parse_condition());
                flow_.drop_action(); // made once, with all of them
                break;
            case Sign::k_transitions: parse_transitions(number); break;
            case Sign::k_transition:
                text_.advance();
                parse_transition(at, number, true);
                break;
            case Sign::k_initial:
            case Sign::k_final:
            case Sign::k_state: parse(name); break;
            case Sign::k_region: parse_region(name); break;
            default:
                text_.fail_expected(
                    "entry, run, exit, handle, transitions, transition, precondition or a state inside");
                break;
            }
        }
        if (asked != 0 && text_.ok()) make_preconditions(number, std::span{preconditions}.first(asked));
        text_.need(Sign::close_brace, "\"}\"");
    }
    constexpr void parse_region(std::string_view state) {
        text_.advance();
        const std::string_view region = parse_region_name();
        text_.need(Sign::open_brace, "\"{\"");
        while (text_.ok() && !text_.is(Sign::close_brace)) parse(state, region);
        text_.need(Sign::close_brace, "\"}\"");
    }
    constexpr void make_preconditions(std::uint16_t number, std::span<const Reader::Place> places) {
        const Reader::Place after = text_.here();
        flow_.begin_action();
        const std::uint16_t first = flow_.first_instruction();
        Operand all;
        for (const Reader::Place& place : places) {
            text_.go_to(place);
            const Operand one = values_.as(place.token, expressions_.parse_condition(), script_bool, "");
            if (!text_.ok()) return;
            all = all.valid() ? values_.apply(find_binary(Operator::both, script_bool, script_bool), all, one)
                              : one;
        }
        const ConditionIndex condition = flow_.add_condition(places.back().token, first, all);
        if (text_.ok()) out_.states[number].precondition = ConditionRef{condition};
        text_.go_to(after);
    }
    constexpr void parse_program(std::uint16_t number, ProgramRef StateRow::* part) {
        const Token at = text_.token();
        text_.advance();
        const std::string_view state = out_.states[number].name;
        if (!(out_.states[number].*part).empty())
            return text_.fail(at, {"state \"", state, "\" has \"", at.text, "\" twice; put both into one"});
        text_.need(Sign::open_brace, "\"{\"");
        peers_.set_command_scope(part == &StateRow::run ? run_scope_ : std::uint16_t{0});
        out_.states[number].*part = ProgramRef{statements_.parse_program({state, ".", at.text})};
        peers_.set_command_scope(0);
        text_.need(Sign::close_brace, "\"}\"");
    }

    // ---- transitions

    constexpr void parse_transitions(std::uint16_t state) {
        text_.advance();
        text_.need(Sign::open_brace, "\"{\"");
        while (text_.ok() && !text_.is(Sign::close_brace)) {
            const Token at = text_.token();
            if (text_.take(Sign::semicolon)) continue;
            if (text_.is(Sign::k_if) || text_.is(Sign::k_select) || text_.is(Sign::k_after) ||
                text_.is(Sign::open_brace))
                parse_transition(at, state, false);
            else if (text_.take(Sign::k_transition))
                parse_transition(at, state, true);
            else
                text_.fail_expected("if, select, after or transition");
        }
        text_.need(Sign::close_brace, "\"}\"");
    }
    /// Parses after "transition", or an item of "transitions", which cannot be on an event.
    constexpr void parse_transition(const Token& at, std::uint16_t state, bool may_be_on_event) {
        TransitionRow row{.from = out_.states[state].name, .to = {}, .line = at.line, .column = at.column};
        if (text_.take(Sign::k_after)) {
            const Token where = text_.token();
            const Operand time = expressions_.parse_known(script_duration, "the time of a transition");
            if (text_.ok() && (!time.literal || time.type != script_duration))
                values_.fail_type(where, time.type, "a duration such as 5s", "");
            row.timed = true;
            row.after = Duration{time.integer};
        } else if (may_be_on_event && !text_.is(Sign::k_if) && !text_.is(Sign::k_select) &&
                   !text_.is(Sign::open_brace)) {
            parse_event(row);
        }
        if (text_.take(Sign::k_if)) parse_guard(row);
        row.then = parse_branch(row);
        const bool selects = parse_select(row, false);
        if (!selects && !row.on_event) return text_.fail_expected("\"select\" and the state that is entered");
        if (!text_.ok()) return;
        if (text_.is(Sign::k_else)) {
            const Token else_at = text_.token();
            text_.advance();
            if (row.guard.empty())
                return text_.fail(
                    else_at, {"found \"else\", but the transition has no condition that could be false"});
            if (!row.on_event) { // the next condition transition, which is always open
                // Also when the time has passed and the condition does not hold.
                TransitionRow other{.from = row.from,
                                    .to = {},
                                    .timed = row.timed,
                                    .after = row.after,
                                    .line = else_at.line,
                                    .column = else_at.column};
                out_.add(out_.transitions, row, "transitions");
                other.then = parse_branch(row);
                if (!parse_select(other, false))
                    return text_.fail_expected("\"select\" and the state that is entered");
                out_.add(out_.transitions, other, "transitions");
                return;
            }
            row.has_otherwise = true;
            row.otherwise = parse_branch(row);
            static_cast<void>(parse_select(row, true));
        }
        text_.skip(Sign::semicolon);
        out_.add(out_.transitions, row, "transitions");
    }
    constexpr void parse_guard(TransitionRow& row) {
        flow_.begin_action();
        const Token where = text_.token();
        const Operand value = expressions_.parse_condition();
        row.guard = ConditionRef{flow_.add_condition(where, flow_.first_instruction(), value)};
        if (text_.take(Sign::k_because)) {
            const Token reason = text_.token();
            row.refusal.text =
                parse_reason("the reason that is shown when the condition does not hold, in quotes");
            if (text_.ok() && row.refusal.text.empty())
                return text_.fail(
                    reason, {"the reason is empty; say what is missing when the condition does not hold"});
        }
        text_.skip(Sign::k_then);
    }
    constexpr std::string_view parse_reason(std::string_view wanted) {
        const Token reason = text_.token();
        return text_.need(Sign::text, wanted) ? out_.keep({reason.text}) : std::string_view{};
    }
    /// Parses the program of a branch, if it has one.
    constexpr ProgramRef parse_branch(const TransitionRow& row) {
        if (!text_.take(Sign::open_brace)) return {};
        const ProgramRef program{
            statements_.parse_program({row.from, ".", row.on_event ? row.event : "transition"})};
        text_.need(Sign::close_brace, "\"}\"");
        return program;
    }
    /// Parses "select State", "select history(State)", "select deep history(State)", "because" and a reason,
    /// for the row that is added next.
    constexpr bool parse_select(TransitionRow& row, bool otherwise) {
        if (!text_.take(Sign::k_select)) return false;
        Token target = text_.need_name("the state that is entered");
        EntryKind enters = EntryKind::initial;
        const bool deep = target.text == "deep" && text_.is(Sign::name);
        if (deep) target = text_.need_name("history");
        if ((target.text == "history" && text_.is(Sign::open_round)) || deep) {
            enters = deep ? EntryKind::deep_history : EntryKind::shallow_history;
            text_.need(Sign::open_round, "\"(\"");
            target = text_.need_name("the composite state whose history is entered");
            text_.need(Sign::close_round, "\")\"");
        }
        if (!text_.ok()) return false;
        (otherwise ? row.otherwise_to : row.to) = target.text;
        if (!otherwise)
            row.enters = enters;
        else if (enters != EntryKind::initial)
            text_.fail(target, {"the else branch enters a state itself and not its history"});
        note_target(static_cast<std::uint16_t>(out_.transitions.count()), otherwise, target);
        if (text_.take(Sign::k_because)) row.because = parse_reason("the reason, in quotes");
        text_.skip(Sign::semicolon);
        return true;
    }
    constexpr void parse_event(TransitionRow& row) {
        Token name;
        const PeerFacet event = peers_.parse_event(name);
        if (!event) return;
        row.on_event = true;
        const std::string_view peer = event.component == 0 ? "" : peers_.name_of(event);
        const std::string_view dot = event.component == 0 ? "" : ".";
        for (std::size_t i = out_.transitions.count(); row.event.empty() && i-- > 0;) {
            const std::string_view known = out_.transitions[i].event; // stores the characters once
            if (known.size() == peer.size() + dot.size() + event->name.size() && known.starts_with(peer) &&
                known.substr(peer.size()).starts_with(dot) && known.ends_with(event->name))
                row.event = known;
        }
        if (row.event.empty()) row.event = out_.keep({peer, dot, event->name});
        if (text_.take(Sign::open_round)) parse_captures(row, name, event->type->elements);
    }
    /// Stores arguments in variables, before the guard is evaluated.
    constexpr void parse_captures(TransitionRow& row, const Token& event, std::span<const TypeId> types) {
        row.first_capture = static_cast<std::uint16_t>(out_.captures.count());
        std::size_t from = 0, i = 0;
        for (; text_.ok() && !text_.is(Sign::close_round); ++i) {
            const Token name = text_.need_name("the variable that receives this argument");
            if (!text_.ok()) return;
            if (i == types.size())
                return text_.fail(name, {"event \"", quoted(event.text), "\" has ",
                                         text_.digits(types.size()), " arguments; leave out what is more"});
            const Symbol* const symbol = scope_.find(name);
            if (symbol == nullptr || !symbol->assignable()) {
                Nearest nearest{name.text};
                for (const Symbol& each : scope_.symbols())
                    if (each.kind == SymbolKind::variable) nearest.consider(each.name);
                return text_.fail_unknown(name, "variable", nearest, "; declare it with var");
            }
            const Operand& to = symbol->operand;
            CaptureRow capture;
            capture.from = static_cast<std::uint16_t>(from);
            capture.size = static_cast<std::uint16_t>(types[i]->size);
            if (to.type == types[i]) {
                capture.raw = to.at;
            } else {
                flow_.begin_action();
                capture.raw = out_.place_in(Region::arguments, types[i]->size);
                capture.first = flow_.first_instruction();
                const Operand value = values_.reckoned(name, at_place(types[i], capture.raw));
                values_.store(name, value, to.type, to.at, " of the event's argument");
                capture.count = static_cast<std::uint16_t>(out_.instruction_count() - capture.first);
            }
            out_.add(out_.captures, capture, "captured arguments");
            ++row.captures;
            from += types[i]->size;
            text_.need_comma();
        }
        text_.need(Sign::close_round, "\")\"");
    }

    // ---- names of states

    constexpr void add_name(std::uint16_t number, const Token& name) noexcept {
        std::uint16_t& head = heads_[name.hash % heads_.size()];
        next_[number] = head;
        head = static_cast<std::uint16_t>(number + 1);
    }
    /// Null: no state has the name.
    [[nodiscard]] constexpr const StateRow* find(std::string_view name, std::uint32_t hash) const noexcept {
        for (std::uint16_t i = heads_[hash % heads_.size()]; i != 0; i = next_[i - 1])
            if (out_.states[i - 1].name == name) return &out_.states[i - 1];
        return nullptr;
    }
    /// Notes where a transition names its target, for the message if there is no such state.
    constexpr void note_target(std::uint16_t transition, bool otherwise, const Token& name) noexcept {
        if (unresolved_used_ < unresolved_.size())
            unresolved_[unresolved_used_++] = {transition, otherwise, name.line, name.column};
    }
    constexpr void resolve(std::string_view& name, std::uint16_t line, std::uint16_t column) {
        if (!text_.ok() || name.empty()) return;
        if (const StateRow* const row = find(name, hash_of(name)); row != nullptr)
            name = row->name;
        else
            text_.fail_unknown(Token{.line = line, .column = column, .text = name}, "state",
                               out_.states.view(), "");
    }

    struct Target {
        std::uint16_t transition = 0;
        bool otherwise = false;
        std::uint16_t line = 0;
        std::uint16_t column = 0;
    };

    Basis& basis_;
    Reader& text_ = basis_.text;
    Emitter& out_ = basis_.out;
    Values& values_ = basis_.values;
    Scope& scope_ = basis_.scope;
    Peers& peers_ = basis_.peers;
    Flow& flow_ = basis_.flow;
    Expressions& expressions_;
    Statements& statements_;
    std::uint16_t run_scope_ = 0;                   // of the run program of the current state
    std::array<std::uint16_t, max_states> outer_{}; // scope of the enclosing state
    std::array<std::uint16_t, 64> heads_{}; // by the hash of the name: 1 + the last such state's number
    std::array<std::uint16_t, max_states> next_{};
    std::array<Target, 192> unresolved_{};
    std::size_t unresolved_used_ = 0;
};

} // namespace tappet::script_detail
