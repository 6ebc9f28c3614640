// A state machine with the facts beyond its table: its component, and the components that its program may
// name. All exports read only this; scripts and C++ tables look the same here.
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

/// A state machine; or a program alone, when `machine` has no states.
struct Chart {
    std::string name;      ///< "loom", "weft.cycle": the component, and the instance if there are several
    std::string component; ///< owner of the machine; events without a component belong to it
    StateMachineTable machine{}; ///< its rows must outlive the chart
    const ProgramTables* programs = nullptr;
    std::span<const Reachable> reach{}; ///< by LinkRow::peer; empty without a script
    std::span<const std::byte> image{}; ///< of this instance; empty: the image of its type
};

/// States that are active at the same time are in different regions.
struct Region {
    StateIndex parent = no_state; ///< the composite around it; no_state: the machine
    std::string name;             ///< empty: the only one
    std::vector<StateIndex> states;
    StateIndex initial = no_state;
};

/// The regions of a machine; those of one composite are adjacent, in the order of their first state.
class Regions {
public:
    explicit Regions(const StateHierarchy& names);
    [[nodiscard]] const std::vector<Region>& all() const { return regions_; }
    [[nodiscard]] std::vector<std::size_t> inside(StateIndex composite) const;
    [[nodiscard]] std::size_t of(StateIndex state) const { return region_of_[state]; }
    /// Returns true when some states are active at the same time.
    [[nodiscard]] bool orthogonal() const;

private:
    std::vector<Region> regions_;
    std::vector<std::size_t> region_of_;
};

/// Returns where an argument of an event is stored.
DataOffset captured_at(const Chart& chart, const CaptureRow& capture);

/// The labels of arrows and boxes.
std::string program_label(const Chart& chart, ProgramRef program);
std::string guard_label(const Chart& chart, ConditionRef guard);
/// Returns "component.event(a, b)" with the variables that receive the arguments.
std::string event_label(const Chart& chart, const TransitionRow& row);

} // namespace tappet::chart
