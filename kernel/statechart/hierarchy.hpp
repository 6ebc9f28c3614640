// A state machine's names as numbers: parents of states, targets of transitions, triggers of events. Computed
// once from the rows, by the checks and by the resolver, at compile time or on the target.
#pragma once

#include "kernel/statechart/table.hpp"

#include <algorithm>
#include <array>

namespace tappet {

/// Number of a trigger: events are numbered in the order in which the transitions first name them.
using TriggerIndex = std::uint16_t;
inline constexpr TriggerIndex no_trigger = 0xffff;

/// Returns the first state of that name, or no_state.
constexpr StateIndex find_state(const StateMachineTable& table, std::string_view name) noexcept {
    for (std::size_t i = 0; i < table.states.size(); ++i)
        if (table.states[i].name == name) return static_cast<StateIndex>(i);
    return no_state;
}

/// Valid for any table within max_states and max_transitions, good or faulty: a missing state is no_state.
struct StateHierarchy {
    const StateMachineTable& table;
    std::array<StateIndex, max_states> parent{};
    std::array<StateIndex, max_states> initial_inside{}; ///< of its first region
    std::array<bool, max_states> composite{};
    std::array<std::uint8_t, max_states>
        depth{}; ///< a top state has 1; 0: deeper than max_state_depth, or a cycle
    std::array<StateIndex, max_transitions> from{};
    std::array<StateIndex, max_transitions> to{};
    std::array<StateIndex, max_transitions> otherwise_to{};
    std::array<TriggerIndex, max_transitions> trigger{};
    std::array<TransitionIndex, max_transitions>
        first_with{};                                    ///< by trigger: the transition that first names it
    std::array<TransitionIndex, max_states> first_out{}; ///< by state: its first transition
    std::array<TransitionIndex, max_transitions> next_out{}; ///< of the same source, in table order
    /// Region 0 is the top of the machine. The regions of a composite are numbered consecutively, in the
    /// order in which its states first name them; without names it has one region.
    std::array<std::uint16_t, max_states> region_of{};    ///< region that contains the state
    std::array<std::uint16_t, max_states> first_region{}; ///< first region inside the state
    std::array<std::uint16_t, max_states> region_count{}; ///< 0: a leaf
    std::array<StateIndex, max_states + 1> region_initial{};
    std::array<StateIndex, max_states + 1> region_name{}; ///< a state in the region
    std::size_t regions = 1;
    std::size_t most_active = 0; ///< most states active at the same time
    std::size_t triggers = 0;
    StateIndex initial_top = no_state;
    StateIndex final_state = no_state;

    explicit constexpr StateHierarchy(const StateMachineTable& of) noexcept : table{of} {
        for (std::size_t i = 0; i < states(); ++i) key_[i] = key_of(table.states[i].name);
        find_parents();
        find_regions();
        count_active();
        first_out.fill(no_transition);
        for (std::size_t t = 0; t < table.transitions.size(); ++t) {
            const TransitionRow& row = table.transitions[t];
            from[t] = find(row.from);
            to[t] = row.to.empty() ? no_state : find(row.to);
            otherwise_to[t] = row.otherwise_to.empty() ? no_state : find(row.otherwise_to);
            trigger[t] = row.on_event ? number_of(row.event, static_cast<TransitionIndex>(t)) : no_trigger;
        }
        for (std::size_t t = transitions(); t-- > 0;) {
            if (from[t] == no_state) continue;
            next_out[t] = first_out[from[t]];
            first_out[from[t]] = static_cast<TransitionIndex>(t);
        }
    }

    /// Calls visit(transition) for the transitions out of a leaf in the order of evaluation: those of the
    /// innermost state first, each state's in table order. Stops when visit returns false.
    template <class Visit> constexpr void for_each_out(StateIndex leaf, const Visit& visit) const {
        for (StateIndex source = leaf; source != no_state; source = parent[source])
            for (TransitionIndex t = first_out[source]; t != no_transition; t = next_out[t])
                if (!visit(t)) return;
    }

    [[nodiscard]] constexpr std::size_t states() const noexcept { return table.states.size(); }
    [[nodiscard]] constexpr std::size_t transitions() const noexcept { return table.transitions.size(); }
    /// Does the same as find_state(), fast enough for hundreds of names in a constant expression.
    [[nodiscard]] constexpr StateIndex find(std::string_view name) const noexcept {
        const std::uint32_t key = key_of(name);
        for (std::size_t i = 0; i < table.states.size(); ++i)
            if (key_[i] == key && table.states[i].name == name) return static_cast<StateIndex>(i);
        return no_state;
    }
    [[nodiscard]] constexpr std::string_view trigger_name(std::size_t number) const noexcept {
        return table.transitions[first_with[number]].event;
    }

    /// Returns the state of that depth that encloses or is `state`; `state` must be at least as deep.
    [[nodiscard]] constexpr StateIndex ancestor(StateIndex state, std::size_t wanted_depth) const noexcept {
        while (state != no_state && depth[state] > wanted_depth) state = parent[state];
        return state;
    }
    [[nodiscard]] constexpr bool is_inside(StateIndex state, StateIndex outer) const noexcept {
        return ancestor(state, depth[outer]) == outer;
    }
    [[nodiscard]] constexpr std::size_t depth_of(StateIndex state) const noexcept { return depth[state]; }
    [[nodiscard]] constexpr std::size_t region_holding(StateIndex state) const noexcept {
        return region_of[state];
    }
    [[nodiscard]] constexpr std::size_t first_region_of(StateIndex state) const noexcept {
        return first_region[state];
    }
    [[nodiscard]] constexpr std::size_t regions_of(StateIndex state) const noexcept {
        return region_count[state];
    }
    [[nodiscard]] constexpr StateIndex initial_of(std::size_t region) const noexcept {
        return region_initial[region];
    }
    [[nodiscard]] constexpr bool orthogonal() const noexcept {
        for (std::size_t i = 0; i < states(); ++i)
            if (region_count[i] > 1) return true;
        return false;
    }
    /// Returns the leaf that is active after `state` was entered, of the first region of each composite;
    /// no_state where a composite has no initial state.
    [[nodiscard]] constexpr StateIndex initial_leaf(StateIndex state) const noexcept {
        while (state != no_state && composite[state]) state = initial_inside[state];
        return state;
    }
    /// Returns the depth of the deepest state that encloses both and is neither; 0: the machine itself.
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
        for (char character : name) key = (key ^ static_cast<unsigned char>(character)) * 16777619u;
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
            if (row.final && final_state == no_state) final_state = self;
        }
        for (std::size_t i = 0; i < states(); ++i) {
            std::size_t levels = 1;
            StateIndex outer = parent[i];
            for (; outer != no_state && levels <= max_state_depth; outer = parent[outer]) ++levels;
            depth[i] = static_cast<std::uint8_t>(levels <= max_state_depth ? levels : 0);
        }
    }
    constexpr void find_regions() noexcept {
        std::array<StateIndex, max_states> first_child{};
        std::array<StateIndex, max_states> next{}; // of the same parent, in table order
        first_child.fill(no_state);
        region_initial.fill(no_state);
        for (std::size_t i = states(); i-- > 0;) {
            if (parent[i] == no_state) continue;
            next[i] = first_child[parent[i]];
            first_child[parent[i]] = static_cast<StateIndex>(i);
        }
        for (std::size_t i = 0; i < states(); ++i) {
            if (parent[i] == no_state && table.states[i].initial && initial_top == no_state)
                initial_top = static_cast<StateIndex>(i);
            first_region[i] = static_cast<std::uint16_t>(regions);
            for (StateIndex child = first_child[i]; child != no_state; child = next[child]) {
                std::size_t r = first_region[i];
                while (r < regions && table.states[region_name[r]].region != table.states[child].region) ++r;
                if (r == regions) {
                    region_name[regions++] = child;
                    ++region_count[i];
                }
                region_of[child] = static_cast<std::uint16_t>(r);
                if (table.states[child].initial && region_initial[r] == no_state) region_initial[r] = child;
            }
            if (region_count[i] != 0) initial_inside[i] = region_initial[first_region[i]];
        }
        region_initial[0] = initial_top;
    }
    constexpr void count_active() noexcept {
        std::array<std::size_t, max_states + 1> inside{}; // by region
        for (std::size_t level = max_state_depth; level > 0; --level)
            for (std::size_t i = 0; i < states(); ++i) {
                if (depth[i] != level) continue;
                std::size_t need = 1;
                for (std::size_t r = 0; r < region_count[i]; ++r) need += inside[first_region[i] + r];
                inside[region_of[i]] = std::max(inside[region_of[i]], need);
            }
        most_active = inside[0];
    }
    constexpr TriggerIndex number_of(std::string_view event, TransitionIndex transition) noexcept {
        for (std::size_t i = 0; i < triggers; ++i)
            if (trigger_name(i) == event) return static_cast<TriggerIndex>(i);
        first_with[triggers] = transition;
        return static_cast<TriggerIndex>(triggers++);
    }
};

} // namespace tappet
