// A state machine with everything that a picture must show: nesting, regions, history, a choice, time, and an
// internal transition. Its programs are C++ functions.
#pragma once

#include "kernel/statechart/rows.hpp"
#include "toolchain/tools/chart/chart.hpp"

#include <array>

namespace tappet::chart {

struct Press {
    void lift() noexcept TAPPET_REALTIME {}
    void lower() noexcept TAPPET_REALTIME {}
    void count() noexcept TAPPET_REALTIME {}
    [[nodiscard]] bool closed() noexcept TAPPET_REALTIME { return true; }
    [[nodiscard]] bool warm() noexcept TAPPET_REALTIME { return true; }
};

// clang-format off
inline constexpr std::array press_states{
    state("idle", initial, entry<&Press::lift>),
    state("working"),
    StateRow{.name = "up",   .parent = "working", .region = "ram",  .initial = true},
    StateRow{.name = "down", .parent = "working", .region = "ram",  .initial = false, .exit = {&statechart::call<&Press::lift, void>}},
    StateRow{.name = "cold", .parent = "working", .region = "heat", .initial = true},
    StateRow{.name = "hot",  .parent = "working", .region = "heat"},
    state("held"),
    state("safe", final, entry<&Press::lower>)};

inline constexpr auto press_transitions = [] {
    std::array rows{
        transition("idle", "working", on("panel.start"), guard<&Press::closed>, then<&Press::count>),
        transition("up", "down", on("panel.stroke")),
        transition("down", "up", after(20ms)),
        transition("cold", "hot", guard<&Press::warm>),
        transition("hot", "cold", on("panel.stroke"), because("the stroke <cools> it")),
        transition("working", "held", on("panel.hold")),
        transition("held", "working", on("panel.go")),
        internal("held", on("panel.mark"), then<&Press::count>),
        transition("held", "idle", after(1500us))};
    rows[0].has_otherwise = true;
    rows[0].otherwise_to = "held";
    rows[6].enters = EntryKind::deep_history;
    return rows;
}();
// clang-format on

inline Chart chart_of(std::string_view name, std::span<const StateRow> states,
                      std::span<const TransitionRow> transitions, TypeId component = nullptr) {
    Chart chart;
    chart.name = chart.component = name;
    chart.machine = {name, states, transitions, component, nullptr, {}};
    return chart;
}
inline Chart press() { return chart_of("press", press_states, press_transitions, type_id<Press>); }

} // namespace tappet::chart
