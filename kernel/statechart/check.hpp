// The checks of a state machine: the first fault as one sentence that names the row, the fault and the cure.
// The same code runs in the C++ compiler for tables and compiled scripts, and on the target for loaded ones.
#pragma once

#include "kernel/base/nearest.hpp"
#include "kernel/base/text.hpp"
#include "kernel/statechart/hierarchy.hpp"

namespace tappet {

namespace statechart {

/// The beginning of a sentence and its line in the script; line 0: not in a script.
struct NamedRow : Sentence {
    std::uint16_t line = 0;
    std::uint16_t column = 0;
};

class Checker {
public:
    explicit constexpr Checker(const StateHierarchy& names) : table_{names.table}, names_{names} {
        for (const StateRow& row : table_.states)
            preconditions_ = preconditions_ || !row.precondition.empty();
    }

    constexpr Sentence check() {
        if (check_states() && check_nesting() && check_roles() && check_transitions() && check_size() &&
            check_all_taken() && check_all_left() && check_all_reached())
            static_cast<void>(check_waits());
        return fault_;
    }
    /// Returns the script line of the faulty row; 0: no row, or a C++ table.
    [[nodiscard]] constexpr std::uint16_t line() const { return line_; }
    [[nodiscard]] constexpr std::uint16_t column() const { return column_; }

private:
    // ---- sentences; fail() is a template and must be complete before a constant expression calls it

    template <class... Pieces> constexpr bool fail(const Pieces&... pieces) {
        fault_ = Sentence{"state machine \"", table_.name, "\": ", pieces...};
        return false;
    }
    template <class... Pieces> constexpr bool fail(const NamedRow& row, const Pieces&... pieces) {
        line_ = row.line;
        column_ = row.column;
        return fail(static_cast<const Sentence&>(row), pieces...);
    }
    constexpr bool fail_twice(const NamedRow& who, std::string_view part) {
        if (part == "component type")
            return fail(who, " has programs of two component types; use those of one");
        if (part == "empty reason")
            return fail(who, " has a condition whose reason is empty; say what is missing then");
        return fail(who, " has more than one ", part, "; keep one");
    }
    constexpr bool fail_foreign(const NamedRow& who, TypeId component) {
        return fail(who, " has a program of ", component->name, ", and the machine is one of ",
                    table_.component == nullptr ? "no component" : table_.component->name,
                    "; use member functions that this component itself declares");
    }
    [[nodiscard]] constexpr bool is_own(TypeId component) const {
        return component == nullptr || component == table_.component;
    }
    [[nodiscard]] constexpr std::string_view name(StateIndex state) const {
        return table_.states[state].name;
    }
    [[nodiscard]] constexpr NamedRow state_text(std::size_t i) const {
        const StateRow& row = table_.states[i];
        return {Sentence{"state \"", row.name, "\""}, row.line, row.column};
    }
    [[nodiscard]] constexpr Sentence where(StateIndex outer) const {
        return outer == no_state ? Sentence{"at the top"} : Sentence{"in \"", name(outer), "\""};
    }
    [[nodiscard]] constexpr NamedRow transition_text(std::size_t t) const {
        const TransitionRow& row = table_.transitions[t];
        Sentence text{"transition ", t + 1, " (\"", row.from, "\""};
        if (!row.to.empty()) text.add(" to \"").add(row.to).add("\"");
        if (row.on_event) text.add(" on \"").add(row.event).add("\"");
        return {text.add(")"), row.line, row.column};
    }
    [[nodiscard]] constexpr Sentence cure_for(std::string_view written) const {
        Nearest nearest{written};
        for (const StateRow& row : table_.states) nearest.consider(row.name);
        if (nearest.best().empty()) return Sentence{"name one of the machine's states, or add this one"};
        return Sentence{"did you mean \"", nearest.best(), "\"?"};
    }

    // ---- each row by itself

    constexpr bool check_states() {
        if (table_.states.empty()) return fail("it has no state; give it an initial and a final one");
        for (std::size_t i = 0; i < names_.states(); ++i) {
            const StateRow& row = table_.states[i];
            if (row.name.empty()) return fail("state ", i + 1, " has no name; give it one");
            if (names_.find(row.name) != i) return fail(state_text(i), " is there twice; rename or drop one");
            if (!row.twice.empty()) return fail_twice(state_text(i), row.twice);
            if (!is_own(row.component)) return fail_foreign(state_text(i), row.component);
            if (!row.parent.empty() && names_.parent[i] == no_state)
                return fail(state_text(i), " is in an unknown state \"", row.parent, "\"; ",
                            cure_for(row.parent));
            if (!row.region.empty() && row.parent.empty())
                return fail(state_text(i), " is in region \"", row.region,
                            "\" of no state; regions lie in a composite: add in(...)");
        }
        return true;
    }

    constexpr bool check_nesting() {
        for (std::size_t i = 0; i < names_.states(); ++i) {
            if (names_.depth[i] != 0) continue;
            std::size_t hops = 0;
            StateIndex outer = names_.parent[i];
            while (outer != no_state && outer != i && hops++ < names_.states()) outer = names_.parent[outer];
            if (outer == i) return fail(state_text(i), " is inside itself; take one in(...) out of the ring");
        }
        for (std::size_t i = 0; i < names_.states(); ++i)
            if (names_.depth[i] == 0)
                return fail(state_text(i), " is more than ", max_state_depth,
                            " levels deep; flatten the hierarchy");
        return true;
    }

    constexpr bool check_roles() {
        for (std::size_t i = 0; i < names_.states(); ++i) {
            const StateRow& row = table_.states[i];
            const StateIndex outer = names_.parent[i];
            const StateIndex first = names_.region_initial[names_.region_of[i]];
            if (row.initial && first != i)
                return fail(state_text(i), " is a second initial state ", where(outer), " beside \"",
                            name(first), "\"; keep one");
            if (row.final && names_.final_state != i)
                return fail(state_text(i), " is a second final state beside \"", name(names_.final_state),
                            "\"; keep one, the safe state that a request leads to from everywhere");
            if (row.final && outer != no_state)
                return fail(
                    state_text(i), " is final inside \"", name(outer),
                    "\"; the final state is safe for the whole machine: take it out of every composite");
            if (row.final && names_.composite[i])
                return fail(state_text(i), " is final and has states inside; the safe state is a plain one");
        }
        if (names_.initial_top == no_state) return fail("no top state is initial; mark the one to start in");
        for (std::size_t i = 0; i < names_.states(); ++i)
            if (Sentence fault = check_regions(static_cast<StateIndex>(i)); !fault.empty())
                return fail(state_text(i), fault);
        if (names_.final_state == no_state)
            return fail(
                "no state is final; mark the safe state that the machine may be brought to from everywhere");
        return true;
    }

    [[nodiscard]] constexpr Sentence check_regions(StateIndex state) const {
        for (std::size_t r = 0; r < names_.region_count[state]; ++r) {
            const std::size_t region = std::size_t{names_.first_region[state]} + r;
            const std::string_view called = table_.states[names_.region_name[region]].region;
            if (called.empty() && names_.region_count[state] > 1)
                return Sentence{" has regions, and \"", name(names_.region_name[region]),
                                "\" is in none of them; give it region(...)"};
            if (names_.region_initial[region] != no_state) continue;
            if (called.empty())
                return Sentence{" is composite and none of its states is initial; mark the one to enter"};
            return Sentence{" has no initial state in region \"", called, "\"; mark the one to enter"};
        }
        return {};
    }

    constexpr bool check_transitions() {
        for (std::size_t t = 0; t < names_.transitions(); ++t) {
            const TransitionRow& row = table_.transitions[t];
            if (names_.from[t] == no_state)
                return fail(transition_text(t), " leaves an unknown state \"", row.from, "\"; ",
                            cure_for(row.from));
            if (!row.to.empty() && names_.to[t] == no_state)
                return fail(transition_text(t), " leads to an unknown state \"", row.to, "\"; ",
                            cure_for(row.to));
            if (!row.twice.empty()) return fail_twice(transition_text(t), row.twice);
            if (!is_own(row.component)) return fail_foreign(transition_text(t), row.component);
            if (row.on_event && row.event.empty())
                return fail(transition_text(t),
                            " waits for an event without a name; write on(\"component.event\")");
            if (row.on_event && row.timed)
                return fail(transition_text(t),
                            " has both on(...) and after(...); make two transitions of it");
            if (row.timed && row.after <= Duration{})
                return fail(transition_text(t),
                            " has a time-out that is not positive; write a time, or leave after(...) out");
            if (row.to.empty() && !row.on_event)
                return fail(
                    transition_text(t),
                    " is internal and has no event, so it would fire in every step; use run<> of the state");
            if (row.to.empty() && row.then.empty() && !row.has_otherwise)
                return fail(transition_text(t), " is internal and does nothing; give it then<>, or drop it");
            if (!check_ends(t)) return false;
        }
        return true;
    }
    // Checks what regions, histories and else branches require of a row.
    constexpr bool check_ends(std::size_t t) {
        const TransitionRow& row = table_.transitions[t];
        if (row.enters != EntryKind::initial && (row.to.empty() || !names_.composite[names_.to[t]]))
            return fail(transition_text(t), " enters by history, and \"", row.to,
                        "\" has no states inside; lead it to a composite state");
        if (row.has_otherwise && !row.on_event)
            return fail(transition_text(t),
                        " has an else branch and no event; write a second transition after it");
        if (row.has_otherwise && row.guard.empty() && !has_precondition(names_.from[t], names_.to[t]))
            return fail(transition_text(t), " has an else branch and nothing to refuse it; give it guard<>");
        if (!row.otherwise_to.empty() && names_.otherwise_to[t] == no_state)
            return fail(transition_text(t), " leads to an unknown state \"", row.otherwise_to,
                        "\" otherwise; ", cure_for(row.otherwise_to));
        for (const StateIndex to : {names_.to[t], names_.otherwise_to[t]})
            if (to != no_state && crosses(names_.from[t], to))
                return fail(transition_text(t),
                            " leads from one region into another of the same state, and both stay active; "
                            "lead it out of that state, or to that state itself");
        return true;
    }
    // Returns whether the path from one state to the other may enter a state with a precondition.
    [[nodiscard]] constexpr bool has_precondition(StateIndex from, StateIndex to) const {
        if (to == no_state || !preconditions_) return false;
        const StateIndex outermost = names_.ancestor(to, names_.shared_depth(from, to) + 1);
        for (std::size_t i = 0; i < names_.states(); ++i)
            if (!table_.states[i].precondition.empty() &&
                names_.is_inside(static_cast<StateIndex>(i), outermost))
                return true;
        return false;
    }
    [[nodiscard]] constexpr bool crosses(StateIndex from, StateIndex to) const {
        const std::size_t next = names_.shared_depth(from, to) + 1;
        return names_.region_of[names_.ancestor(from, next)] != names_.region_of[names_.ancestor(to, next)];
    }

    // ---- the rows together

    constexpr bool check_size() {
        if (names_.most_active > max_active_states)
            return fail(names_.most_active, " of its states may be active at the same time and ",
                        max_active_states, " may; take regions out of it");
        if (names_.triggers > max_state_events)
            return fail("it hears ", names_.triggers, " events and may hear ", max_state_events,
                        "; split it over components");
        std::size_t leaf_transitions = 2; // start and reset
        for (std::size_t i = 0; i < names_.states(); ++i) {
            if (names_.composite[i]) continue;
            ++leaf_transitions; // to the final state
            names_.for_each_out(static_cast<StateIndex>(i), [&](TransitionIndex) {
                ++leaf_transitions;
                return true;
            });
        }
        if (leaf_transitions <= max_leaf_transitions) return true;
        return fail("its transitions lead out of ", leaf_transitions,
                    " plain states together and may out of ", max_leaf_transitions,
                    "; move transitions of wide composites inwards, or split it");
    }

    // The first row blocks the second: it comes first and holds whenever the second could hold.
    [[nodiscard]] constexpr bool blocks(std::size_t first, std::size_t second) const {
        const TransitionRow& a = table_.transitions[first];
        const TransitionRow& b = table_.transitions[second];
        if (names_.trigger[first] != names_.trigger[second]) return false;
        if (a.has_otherwise)
            return a.otherwise_to.empty() ||
                   !has_precondition(names_.from[first], names_.otherwise_to[first]);
        if (!a.guard.empty() || has_precondition(names_.from[first], names_.to[first])) return false;
        if (!a.timed) return true;
        return b.timed && names_.from[first] == names_.from[second] && a.after <= b.after;
    }

    constexpr bool check_all_taken() {
        std::array<bool, max_transitions> open{};
        std::array<TransitionIndex, max_transitions> blocker{};
        for (std::size_t i = 0; i < names_.states(); ++i) {
            if (names_.composite[i]) continue;
            const auto leaf = static_cast<StateIndex>(i);
            names_.for_each_out(leaf, [&](TransitionIndex t) {
                bool blocked = false;
                names_.for_each_out(leaf, [&](TransitionIndex earlier) {
                    if (earlier == t) return false;
                    blocked = blocks(earlier, t);
                    if (blocked) blocker[t] = earlier;
                    return !blocked;
                });
                open[t] = open[t] || !blocked;
                return true;
            });
        }
        for (std::size_t t = 0; t < names_.transitions(); ++t)
            if (!open[t])
                return fail(
                    transition_text(t), " can never be taken, ", transition_text(blocker[t]),
                    " always comes first; give that one a guard<>, put this one before it, or drop it");
        return true;
    }

    constexpr bool check_all_left() {
        for (std::size_t i = 0; i < names_.states(); ++i) {
            if (names_.composite[i] || table_.states[i].final) continue;
            const auto leaf = static_cast<StateIndex>(i);
            if (!is_left(leaf))
                return fail(state_text(i), " has no way out; give it a transition, or mark it final");
        }
        return true;
    }

    // Returns whether the leaf can be left: by its own transition, by one of an enclosing state, or because
    // another region leaves such a state.
    [[nodiscard]] constexpr bool is_left(StateIndex leaf) const {
        bool left = false;
        const auto leads_away = [&](StateIndex to) {
            return to != no_state && names_.initial_leaf(to) != leaf;
        };
        names_.for_each_out(leaf, [&](TransitionIndex t) {
            left = leads_away(names_.to[t]) || leads_away(names_.otherwise_to[t]);
            return !left;
        });
        for (StateIndex outer = names_.parent[leaf]; outer != no_state && !left; outer = names_.parent[outer])
            for (std::size_t t = 0; t < names_.transitions() && names_.region_count[outer] > 1; ++t)
                for (const StateIndex to : {names_.to[t], names_.otherwise_to[t]})
                    left = left || (to != no_state && names_.is_inside(names_.from[t], outer) &&
                                    !names_.is_inside(to, outer));
        return left;
    }

    constexpr bool check_all_reached() {
        std::array<bool, max_states> reached{};
        std::array<bool, max_states> entered{}; // including their initial states
        std::array<StateIndex, 2 * max_states> open{};
        std::size_t waiting = 0;
        const auto reach = [&](StateIndex state) {
            if (!reached[state]) open[waiting++] = state;
            reached[state] = true;
        };
        const auto enter = [&](StateIndex state) {
            if (!entered[state]) open[waiting++] = state;
            entered[state] = reached[state] = true;
        };
        std::array<bool, max_states> remembers{}; // by shallow history; includes the initial states inside
        for (std::size_t t = 0; t < names_.transitions(); ++t)
            if (table_.transitions[t].enters == EntryKind::shallow_history) remembers[names_.to[t]] = true;
        const auto lead_to = [&](StateIndex from, StateIndex target) { // with other regions on the way
            enter(target);
            const std::size_t kept = names_.shared_depth(from, target);
            for (StateIndex s = target, outer = names_.parent[s];
                 outer != no_state && names_.depth[outer] > kept; s = outer, outer = names_.parent[s])
                for (std::size_t r = 0; r < names_.region_count[outer]; ++r)
                    if (const std::size_t region = names_.first_region[outer] + r;
                        region != names_.region_of[s])
                        enter(names_.region_initial[region]);
        };
        enter(names_.initial_top);
        enter(names_.final_state); // always valid by request
        while (waiting > 0) {
            const StateIndex state = open[--waiting];
            const StateIndex outer = names_.parent[state];
            if (outer != no_state) {
                reach(outer);
                if (remembers[outer]) enter(state);
            }
            for (std::size_t r = 0; entered[state] && r < names_.region_count[state]; ++r)
                enter(names_.region_initial[names_.first_region[state] + r]);
            for (TransitionIndex t = names_.first_out[state]; t != no_transition; t = names_.next_out[t])
                for (const StateIndex to : {names_.to[t], names_.otherwise_to[t]})
                    if (to != no_state) lead_to(state, to);
        }
        for (std::size_t i = 0; i < names_.states(); ++i)
            if (!reached[i])
                return fail(state_text(i),
                            " is never entered; lead a transition to it, make it initial, or drop it");
        return true;
    }

    // Follows the transitions that can always be taken. A cycle of them would make a step endless.
    constexpr bool check_waits() {
        std::array<StateIndex, max_states> next{};
        for (std::size_t i = 0; i < names_.states(); ++i) {
            const std::size_t t =
                names_.composite[i] ? names_.transitions() : free_transition_of(static_cast<StateIndex>(i));
            next[i] = t == names_.transitions() ? no_state : names_.initial_leaf(names_.to[t]);
        }
        for (std::size_t i = 0; i < names_.states(); ++i) {
            std::size_t hops = 0;
            auto last = static_cast<StateIndex>(i);
            StateIndex leaf = next[i];
            for (; leaf != no_state && leaf != i && hops < names_.states(); leaf = next[leaf])
                last = leaf, ++hops;
            if (leaf == i)
                return fail(state_text(i), " comes back to itself without waiting, by ",
                            transition_text(free_transition_of(last)),
                            "; give one transition of the ring on(...), after(...) or guard<>");
        }
        return true;
    }
    [[nodiscard]] constexpr std::size_t free_transition_of(StateIndex leaf) const {
        std::size_t found = names_.transitions();
        for (StateIndex state = leaf; state != no_state; state = names_.parent[state])
            if (may_wait(table_.states[state].entry) || may_wait(table_.states[state].run)) return found;
        names_.for_each_out(leaf, [&](TransitionIndex t) {
            const TransitionRow& row = table_.transitions[t];
            if (!row.on_event && !row.timed && row.guard.empty()) found = t;
            return found != t;
        });
        return found;
    }
    [[nodiscard]] constexpr bool may_wait(const ProgramRef& program) const {
        return program.program != no_program && table_.programs != nullptr &&
               table_.programs->programs[program.program].may_wait;
    }

    const StateMachineTable& table_;
    const StateHierarchy& names_;
    bool preconditions_ = false;
    Sentence fault_;
    std::uint16_t line_ = 0;
    std::uint16_t column_ = 0;
};

constexpr Sentence check_limits(const StateMachineTable& table) {
    if (table.states.size() > max_states)
        return Sentence{"state machine \"",
                        table.name,
                        "\": it has ",
                        table.states.size(),
                        " states and may have ",
                        max_states,
                        "; split it over components"};
    if (table.transitions.size() > max_transitions)
        return Sentence{"state machine \"",
                        table.name,
                        "\": it has ",
                        table.transitions.size(),
                        " transitions and may have ",
                        max_transitions,
                        "; split it over components"};
    return {};
}

} // namespace statechart

/// Returns the first fault; empty when the machine is good. Bounded, no heap; not for real-time threads.
constexpr Sentence check(const StateMachineTable& table) {
    if (Sentence fault = statechart::check_limits(table); !fault.empty()) return fault;
    return statechart::Checker{StateHierarchy{table}}.check();
}

} // namespace tappet
