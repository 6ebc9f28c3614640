// A state machine with what its table alone does not say: who runs it, and what its program may name. Every
// export reads this and nothing else; scripts and C++ tables look the same here.
#pragma once

#include "kernel/script/reach.hpp"
#include "kernel/statechart/hierarchy.hpp"
#include "toolchain/tools/chart/names.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::chart {

/// A state machine, or a program alone: then `machine` has no states.
struct Chart {
    std::string name;      ///< "loom", "weft.cycle": the component, and the instance where it has several
    std::string component; ///< whose machine it is; events without a component are this one's
    StateMachineTable machine{}; ///< its rows outlive the chart
    const ProgramTables* programs = nullptr;
    std::span<const Reachable> reach{}; ///< by LinkRow::peer; empty where there is no script
    std::span<const std::byte> image{}; ///< of this instance; empty: the image of its type
};

/// Where states are active at the same time, each is in a region of its own.
struct Region {
    StateIndex parent = no_state; ///< the composite around it; no_state: the machine
    std::string name;             ///< empty: the only one
    std::vector<StateIndex> states;
    StateIndex initial = no_state;
};

/// Regions of a machine, those of a composite side by side and in the order of their first state.
class Regions {
public:
    explicit Regions(const StateHierarchy& names);
    [[nodiscard]] const std::vector<Region>& all() const { return regions_; }
    [[nodiscard]] std::vector<std::size_t> inside(StateIndex composite) const;
    [[nodiscard]] std::size_t of(StateIndex state) const { return region_of_[state]; }
    /// Some states are active at the same time.
    [[nodiscard]] bool orthogonal() const;

private:
    std::vector<Region> regions_;
    std::vector<std::size_t> region_of_;
};

/// Where an argument of an event comes to lie.
DataOffset captured_at(const Chart& chart, const CaptureRow& capture);

/// The texts that an arrow and a box bear.
std::string program_label(const Chart& chart, ProgramRef program);
std::string guard_label(const Chart& chart, ConditionRef guard);
/// "component.event(a, b)" with the variables that receive the arguments.
std::string event_label(const Chart& chart, const TransitionRow& row);

} // namespace tappet::chart
