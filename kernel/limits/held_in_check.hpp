// Checks a held output against the programs of a state machine that the compiler can read: the
// programs of scripts, whose operations, events and constants it follows through the table's rows. C++
// functions are not readable; at run time the output's gate judges their orders like all others.
#pragma once

#include "kernel/machine/table/index.hpp"
#include "kernel/machine/table/unit_rows.hpp"
#include "kernel/program/orders.hpp"
#include "kernel/statechart/hierarchy.hpp"

#include <span>
#include <string_view>

namespace tappet::held_detail {

/// The effect of an order, or of a sequence of them, on the output.
enum class Effect : std::uint8_t { none, on, off, unknown };

/// A held output, and the states of one type of a unit that hold it.
struct HeldType {
    const MachineView& m;
    const TableIndexView& index;
    const BehaviourRow& row;
    const ScriptUnit& unit;
    const BehaviourType& type;
    std::span<const std::string_view> states; ///< in which it may be on
    std::size_t driver = nowhere;
    std::size_t output = 0; ///< of the driver
    StateHierarchy tree{type.machine};

    // ---- states

    [[nodiscard]] constexpr bool is_named(StateIndex state) const {
        for (const std::string_view name : states)
            if (same_text(name, type.machine.states[state].name)) return true;
        return false;
    }
    [[nodiscard]] constexpr bool is_within(StateIndex state, StateIndex outer) const {
        for (std::size_t n = 0; n < max_state_depth && state != no_state; ++n, state = tree.parent[state])
            if (state == outer) return true;
        return false;
    }
    /// Whether the output may be on in a state: it, or a state around it, is named.
    [[nodiscard]] constexpr bool may_be_on(StateIndex state) const {
        for (std::size_t n = 0; n < max_state_depth && state != no_state; ++n, state = tree.parent[state])
            if (is_named(state)) return true;
        return false;
    }
    /// Whether it may be on in a state, or in one inside it.
    [[nodiscard]] constexpr bool may_be_on_within(StateIndex outer) const {
        for (std::size_t s = 0; s < type.machine.states.size(); ++s)
            if (is_within(static_cast<StateIndex>(s), outer) && may_be_on(static_cast<StateIndex>(s)))
                return true;
        return outer == no_state;
    }

    // ---- programs

    [[nodiscard]] constexpr bool drives(End end) const {
        return end.component == driver && facet_at(m, end).device_output == output + 1;
    }
    /// The effect of a value at a facet of the driver.
    [[nodiscard]] constexpr Effect of_value(End end, double value) const {
        return value == facet_at(m, end).safe_value ? Effect::off : Effect::on;
    }
    [[nodiscard]] constexpr Effect of_operation(End end) const {
        return of_value(end, facet_at(m, end).name.ends_with(".set") ? 1 : 0);
    }
    [[nodiscard]] constexpr Effect of(const ProgramOrder& order) const {
        const LinkRow& link = type.tables.links[order.link];
        const End end{component_of(m, row.component, unit, link.peer), link.facet};
        Effect effect = Effect::none;
        switch (facet_at(m, end).kind) {
        case FacetKind::operation:
            if (drives(end)) effect = of_operation(end);
            break;
        case FacetKind::event:
            for (const Link& each : index.reactions)
                if (each.from == end && drives(each.to)) effect = of_operation(each.to);
            break;
        default:
            for (const Link& each : index.connections)
                if (each.from == end && drives(each.to))
                    effect = order.is_constant ? of_value(each.to, order.value) : Effect::unknown;
        }
        return effect;
    }
    /// Returns the last effect of a program; `line`: of the order.
    [[nodiscard]] constexpr Effect last_of(const ProgramRef& ref, std::uint16_t& line) const {
        Effect last = Effect::none;
        each_effect(ref, [&](Effect effect, std::uint16_t at) { last = effect, line = at; });
        return last;
    }
    /// Returns the line of the first order of a program that turns the output on; 0: none.
    [[nodiscard]] constexpr std::uint16_t on_in(const ProgramRef& ref) const {
        std::uint16_t line = 0;
        each_effect(ref, [&](Effect effect, std::uint16_t at) {
            if (effect == Effect::on && line == 0) line = at;
        });
        return line;
    }
    template <class Visit> constexpr void each_effect(const ProgramRef& ref, const Visit& visit) const {
        if (ref.program == no_program) return;
        const ProgramRow& program = type.tables.programs[ref.program];
        const auto look = [&](const ProgramOrder& order) {
            if (order.node < program.first || order.node >= program.last) return;
            if (const Effect effect = of(order); effect != Effect::none)
                visit(effect, type.tables.nodes[order.node].line);
        };
        if (type.tables.instructions.empty())
            for (const ProgramOrder& order : type.orders) look(order);
        else
            for_each_order(type.tables, look);
    }

    // ---- faults

    /// A program that turns the output on where it must be off.
    [[nodiscard]] constexpr Sentence turned_on(std::string_view part, StateIndex state, const ProgramRef& ref,
                                               StateIndex seen_in) const {
        const std::uint16_t line = on_in(ref);
        if (line == 0) return {};
        return Sentence{"the ",
                        part,
                        " of \"",
                        type.machine.states[state].name,
                        "\" of \"",
                        type.name,
                        "\" turns it on in line ",
                        line,
                        ", outside of its states; exchange set and clear there, or add \"",
                        type.machine.states[seen_in].name,
                        "\" to the states"};
    }
    /// The programs that run when a transition is taken, after those of the states that are left.
    [[nodiscard]] constexpr Effect on_the_way(StateIndex from, StateIndex to, const ProgramRef& then,
                                              std::uint16_t& line) const {
        Effect last = last_of(then, line);
        const auto add = [&](const ProgramRef& ref) {
            std::uint16_t at = 0;
            if (const Effect effect = last_of(ref, at); effect != Effect::none) last = effect, line = at;
        };
        for (std::size_t s = type.machine.states.size(); s-- > 0;)
            if (const auto state = static_cast<StateIndex>(s);
                is_within(state, from) || is_within(from, state))
                if (!is_within(to, state) || state == from || state == to) add(type.machine.states[s].exit);
        for (std::size_t s = 0; s < type.machine.states.size(); ++s)
            if (const auto state = static_cast<StateIndex>(s); is_within(state, to) || is_within(to, state))
                if (!is_within(from, state) || state == from || state == to)
                    add(type.machine.states[s].entry);
        return last;
    }
    /// Whether the programs inside a state leave the output on, if nothing on the way does more.
    [[nodiscard]] constexpr bool stays_on(StateIndex from, std::uint16_t& line) const {
        bool turned_on = false, turned_off = false;
        for (std::size_t s = 0; s < type.machine.states.size(); ++s) {
            if (!is_within(static_cast<StateIndex>(s), from)) continue;
            const StateRow& state = type.machine.states[s];
            for (const ProgramRef& ref : {state.entry, state.run, state.handle}) {
                std::uint16_t at = 0;
                const Effect effect = last_of(ref, at);
                if (effect == Effect::on) turned_on = true, line = at;
                turned_off |= effect == Effect::off || effect == Effect::unknown;
            }
        }
        return turned_on && !turned_off;
    }
    [[nodiscard]] constexpr Sentence left_on(StateIndex from, StateIndex to, const ProgramRef& then) const {
        if (from == no_state || to == no_state || !may_be_on_within(from) || may_be_on_within(to)) return {};
        std::uint16_t line = 0;
        const Effect last = on_the_way(from, to, then, line);
        if (last == Effect::off || last == Effect::unknown) return {};
        if (last == Effect::none && !stays_on(from, line)) return {};
        return Sentence{"state \"",
                        type.machine.states[from].name,
                        "\" of \"",
                        type.name,
                        "\" is left to \"",
                        type.machine.states[to].name,
                        "\" and leaves it on (line ",
                        line,
                        "); turn it off in the exit program of \"",
                        type.machine.states[from].name,
                        "\": set and clear may be exchanged there"};
    }

    [[nodiscard]] constexpr Sentence check() const {
        const auto& rows = type.machine.states;
        for (std::size_t s = 0; s < rows.size(); ++s) {
            const auto state = static_cast<StateIndex>(s);
            if (may_be_on(state)) continue;
            const std::pair<std::string_view, ProgramRef> programs[] = {{"entry program", rows[s].entry},
                                                                        {"run program", rows[s].run},
                                                                        {"handle program", rows[s].handle},
                                                                        {"exit program", rows[s].exit}};
            for (const auto& [part, ref] : programs)
                if (const Sentence fault = turned_on(part, state, ref, state); !fault.empty()) return fault;
        }
        for (std::size_t t = 0; t < type.machine.transitions.size(); ++t) {
            const TransitionRow& row_of = type.machine.transitions[t];
            const StateIndex from = tree.from[t], to = tree.to[t], otherwise = tree.otherwise_to[t];
            for (const auto& [target, ref] :
                 {std::pair{to, row_of.then}, std::pair{otherwise, row_of.otherwise}}) {
                const StateIndex seen_in = target == no_state ? from : target;
                if (seen_in != no_state && !may_be_on_within(seen_in))
                    if (const Sentence fault = turned_on("transition program", from, ref, seen_in);
                        !fault.empty())
                        return fault;
                if (const Sentence fault = left_on(from, target, ref); !fault.empty()) return fault;
            }
        }
        for (std::size_t s = 0; s < rows.size(); ++s) // by request
            if (const auto state = static_cast<StateIndex>(s); may_be_on(state) && !tree.composite[s])
                if (const Sentence fault = left_on(state, tree.final_state, {}); !fault.empty()) return fault;
        return {};
    }
};

/// Returns the first fault of the readable programs of a behaviour. Types without one of the states are
/// children of a machine that has them, or drive something else: the gate alone judges them.
constexpr Sentence check_programs(const MachineView& m, const TableIndexView& index, const BehaviourRow& row,
                                  std::span<const std::string_view> states, std::size_t driver,
                                  std::size_t output) {
    const ScriptUnit unit = row.unit();
    for (const BehaviourType& type : unit.types) {
        if (type.is_program() || type.tables.nodes.empty()) continue;
        const HeldType held{m, index, row, unit, type, states, driver, output};
        bool has_one = false;
        for (std::size_t s = 0; s < type.machine.states.size(); ++s)
            has_one |= held.is_named(static_cast<StateIndex>(s));
        if (!has_one) continue;
        if (const Sentence fault = held.check(); !fault.empty()) return fault;
    }
    return {};
}

} // namespace tappet::held_detail
