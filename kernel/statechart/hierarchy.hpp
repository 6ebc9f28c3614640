// A state machine's names as numbers: who is inside whom, where a transition leads, which event is which
// trigger. Computed once from the rows, by the checks and by the resolver, at compile time or on the target.
#pragma once

#include "kernel/statechart/table.hpp"

#include <array>

namespace tappet {

/// Number of a trigger: events in the order in which the transitions first name them.
using TriggerIndex = std::uint16_t;
inline constexpr TriggerIndex no_trigger = 0xffff;

/// The first state of that name, or no_state.
constexpr StateIndex find_state(const StateMachineTable& table, std::string_view name) noexcept {
    for (std::size_t i = 0; i < table.states.size(); ++i)
        if (table.states[i].name == name) return static_cast<StateIndex>(i);
    return no_state;
}

/// Holds for any table within max_states and max_transitions, good or faulty: what is not there is no_state.
struct StateHierarchy {
    const StateMachineTable& table;
    std::array<StateIndex, max_states> parent{};
    std::array<StateIndex, max_states> initial_inside{}; ///< the first initial state right inside
    std::array<bool, max_states> composite{};
    std::array<std::uint8_t, max_states>
        depth{}; ///< a top state has 1; 0: deeper than max_state_depth, or a cycle
    std::array<StateIndex, max_transitions> from{};
    std::array<StateIndex, max_transitions> to{};
    std::array<TriggerIndex, max_transitions> trigger{};
    std::array<TransitionIndex, max_transitions>
        first_with{};                                    ///< by trigger: the transition that first names it
    std::array<TransitionIndex, max_states> first_out{}; ///< by state: its first transition
    std::array<TransitionIndex, max_transitions> next_out{}; ///< of the same source, in table order
    std::size_t triggers = 0;
    StateIndex initial_top = no_state;
    StateIndex final_state = no_state;

    explicit constexpr StateHierarchy(const StateMachineTable& of) noexcept : table{of} {
        for (std::size_t i = 0; i < states(); ++i) key_[i] = key_of(table.states[i].name);
        find_parents();
        first_out.fill(no_transition);
        for (std::size_t t = 0; t < table.transitions.size(); ++t) {
            const TransitionRow& row = table.transitions[t];
            from[t] = find(row.from);
            to[t] = row.to.empty() ? no_state : find(row.to);
            trigger[t] = row.on_event ? number_of(row.event, static_cast<TransitionIndex>(t)) : no_trigger;
        }
        for (std::size_t t = transitions(); t-- > 0;) {
            if (from[t] == no_state) continue;
            next_out[t] = first_out[from[t]];
            first_out[from[t]] = static_cast<TransitionIndex>(t);
        }
    }

    /// Calls visit(transition) for those that lead out of a leaf in the order in which they are asked: the
    /// innermost state's first, each state's in table order. It ends when visit returns false.
    template <class Visit> constexpr void for_each_out(StateIndex leaf, const Visit& visit) const {
        for (StateIndex source = leaf; source != no_state; source = parent[source])
            for (TransitionIndex t = first_out[source]; t != no_transition; t = next_out[t])
                if (!visit(t)) return;
    }

    [[nodiscard]] constexpr std::size_t states() const noexcept { return table.states.size(); }
    [[nodiscard]] constexpr std::size_t transitions() const noexcept { return table.transitions.size(); }
    /// find_state(), but quick enough for hundreds of names in a constant expression.
    [[nodiscard]] constexpr StateIndex find(std::string_view name) const noexcept {
        const std::uint32_t key = key_of(name);
        for (std::size_t i = 0; i < table.states.size(); ++i)
            if (key_[i] == key && table.states[i].name == name) return static_cast<StateIndex>(i);
        return no_state;
    }
    [[nodiscard]] constexpr std::string_view trigger_name(std::size_t number) const noexcept {
        return table.transitions[first_with[number]].event;
    }

    /// The state of that depth around (or equal to) a state that is at least as deep.
    [[nodiscard]] constexpr StateIndex ancestor(StateIndex state, std::size_t wanted_depth) const noexcept {
        while (state != no_state && depth[state] > wanted_depth) state = parent[state];
        return state;
    }
    [[nodiscard]] constexpr bool is_inside(StateIndex state, StateIndex outer) const noexcept {
        return ancestor(state, depth[outer]) == outer;
    }
    /// The leaf that is active once a state was entered; no_state where a composite has no initial state.
    [[nodiscard]] constexpr StateIndex initial_leaf(StateIndex state) const noexcept {
        while (state != no_state && composite[state]) state = initial_inside[state];
        return state;
    }
    /// Depth of the deepest state that is around both and is neither of them; 0: the machine itself.
    [[nodiscard]] constexpr std::size_t shared_depth(StateIndex a, StateIndex b) const noexcept {
        std::size_t level = 0;
        while (level + 1 < depth[a] && level + 1 < depth[b] &&
               ancestor(a, level + 1) == ancestor(b, level + 1))
            ++level;
        return level;
    }

private:
    std::array<std::uint32_t, max_states> key_{}; // of the states' names

    static constexpr std::uint32_t key_of(std::string_view name) noexcept {
        std::uint32_t key = 2166136261u; // FNV-1a
        for (char letter : name) key = (key ^ static_cast<unsigned char>(letter)) * 16777619u;
        return key;
    }
    constexpr void find_parents() noexcept {
        parent.fill(no_state);
        initial_inside.fill(no_state);
        for (std::size_t i = 0; i < states(); ++i) {
            const StateRow& row = table.states[i];
            const auto self = static_cast<StateIndex>(i);
            if (!row.parent.empty()) parent[i] = find(row.parent);
            if (parent[i] != no_state) composite[parent[i]] = true;
            StateIndex& initial = parent[i] == no_state ? initial_top : initial_inside[parent[i]];
            if (row.initial && initial == no_state) initial = self;
            if (row.final && final_state == no_state) final_state = self;
        }
        for (std::size_t i = 0; i < states(); ++i) {
            std::size_t levels = 1;
            StateIndex outer = parent[i];
            for (; outer != no_state && levels <= max_state_depth; outer = parent[outer]) ++levels;
            depth[i] = static_cast<std::uint8_t>(levels <= max_state_depth ? levels : 0);
        }
    }
    constexpr TriggerIndex number_of(std::string_view event, TransitionIndex transition) noexcept {
        for (std::size_t i = 0; i < triggers; ++i)
            if (trigger_name(i) == event) return static_cast<TriggerIndex>(i);
        first_with[triggers] = transition;
        return static_cast<TriggerIndex>(triggers++);
    }
};

} // namespace tappet
