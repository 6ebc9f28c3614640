// Paths of a state machine to one of its states: the distance of each leaf in transitions, and the
// transitions that lead nearer. For explaining a machine that does not move on; not for real-time threads.
#pragma once

#include "kernel/statechart/resolve.hpp"

namespace tappet {

class Ways {
public:
    static constexpr std::uint16_t none = 0xffff;

    constexpr Ways(const ResolvedView& machine, StateIndex wanted) : machine_{machine} {
        for (std::size_t s = 0; s < away_.size(); ++s)
            away_[s] =
                s < machine.sizes.states && is_leaf(s) && machine.is_inside(index(s), wanted) ? 0 : none;
        for (bool changes = true; changes;) { // one more transition a round; the last changes nothing
            changes = false;
            for (std::size_t t = 0; t < transitions(); ++t)
                for (std::size_t leaf = 0; leaf < machine.sizes.states; ++leaf)
                    if (starts_in(t, index(leaf)) && after(t) < none && after(t) + 1u < away_[leaf])
                        away_[leaf] = static_cast<std::uint16_t>(after(t) + 1u), changes = true;
        }
    }

    /// Returns the number of transitions from that leaf to the wanted state; none: no path leads there.
    [[nodiscard]] constexpr std::uint16_t away(StateIndex leaf) const { return away_[leaf]; }
    [[nodiscard]] constexpr bool leads_nearer(std::size_t transition, StateIndex leaf) const {
        return starts_in(transition, leaf) && after(transition) < away_[leaf];
    }
    /// Returns the next leaf on a shortest path; no_state: there is none.
    [[nodiscard]] constexpr StateIndex next(StateIndex leaf) const {
        for (std::size_t t = 0; t < transitions(); ++t) {
            StateIndex nearest = no_state;
            if (leads_nearer(t, leaf) && after(t) + 1u == away_[leaf])
                for_each_arrival(t, [&](StateIndex state) {
                    if (away_[state] == after(t)) nearest = state;
                });
            if (nearest != no_state) return nearest;
        }
        return no_state;
    }

private:
    static constexpr StateIndex index(std::size_t state) { return static_cast<StateIndex>(state); }
    [[nodiscard]] constexpr bool is_leaf(std::size_t state) const {
        return machine_.plans[state].regions == 0;
    }
    [[nodiscard]] constexpr std::size_t transitions() const { return machine_.table.transitions.size(); }
    [[nodiscard]] constexpr bool starts_in(std::size_t transition, StateIndex leaf) const {
        return is_leaf(leaf) && machine_.is_inside(leaf, machine_.arcs[first_arc + transition].source);
    }
    // The leaves that it enters; by history it may be any inside its target.
    template <class Visit> constexpr void for_each_arrival(std::size_t transition, const Visit& visit) const {
        const StateArc& arc = machine_.arcs[first_arc + transition];
        for (StepIndex at = arc.steps; !is_last(machine_.steps[at].kind); ++at) {
            const TransitionStep& step = machine_.steps[at];
            if (step.kind == StepKind::place && is_leaf(step.state)) visit(step.state);
            if (step.kind != StepKind::remembered) continue;
            for (std::size_t leaf = 0; leaf < machine_.sizes.states; ++leaf)
                if (is_leaf(leaf) && machine_.is_inside(index(leaf), arc.to)) visit(index(leaf));
        }
    }
    [[nodiscard]] constexpr std::uint16_t after(std::size_t transition) const {
        std::uint16_t least = none;
        for_each_arrival(transition, [&](StateIndex leaf) { least = std::min(least, away_[leaf]); });
        return least;
    }

    ResolvedView machine_;
    std::array<std::uint16_t, max_states> away_{};
};

} // namespace tappet
