// Behaviour rows: the state machine that drives a component, or the room kept for one that is loaded later.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/statechart/rows.hpp"

#include <cstdint>
#include <string_view>

namespace tappet {

/// What a behaviour that is loaded later may use; reserved from the start, since nothing is created at run
/// time.
struct Slot {
    static constexpr std::size_t max_names = 16;
    std::uint32_t nodes = 0;
    std::uint32_t data_bytes = 0;
    std::uint32_t depth = 0;
    std::uint32_t command_slots = 0;
    std::uint32_t timers = 0;
    Bounded<std::string_view, max_names> peers{};      ///< components
    Bounded<std::string_view, max_names> operations{}; ///< component.operation
    Bounded<std::string_view, max_names> events{};     ///< component.event
    bool too_many = false;
};

struct BehaviourRow {
    std::string_view component{};
    StateMachineTable machine{}; ///< without states: a slot
    Slot slot{};

    [[nodiscard]] constexpr bool is_slot() const noexcept { return machine.component == nullptr; }
};

template <class... Names>
constexpr Bounded<std::string_view, Slot::max_names> names(const Names&... each) {
    static_assert(sizeof...(Names) <= Slot::max_names,
                  "a slot reaches at most 16 names of a kind: split the behaviour");
    Bounded<std::string_view, Slot::max_names> list;
    (static_cast<void>(list.push(std::string_view{each})), ...);
    return list;
}

namespace detail {

template <class Tag>
struct SlotNumber {
    std::uint32_t value;
};
template <class Tag>
struct SlotNames {
    Bounded<std::string_view, Slot::max_names> list;
};
struct NodesTag {};
struct DataTag {};
struct DepthTag {};
struct CommandsTag {};
struct TimersTag {};
struct PeersTag {};
struct OperationsTag {};
struct EventsTag {};

constexpr void apply(Slot& row, SlotNumber<NodesTag> option) noexcept { row.nodes = option.value; }
constexpr void apply(Slot& row, SlotNumber<DataTag> option) noexcept { row.data_bytes = option.value; }
constexpr void apply(Slot& row, SlotNumber<DepthTag> option) noexcept { row.depth = option.value; }
constexpr void apply(Slot& row, SlotNumber<CommandsTag> option) noexcept { row.command_slots = option.value; }
constexpr void apply(Slot& row, SlotNumber<TimersTag> option) noexcept { row.timers = option.value; }
constexpr void apply(Slot& row, const SlotNames<PeersTag>& option) noexcept { row.peers = option.list; }
constexpr void apply(Slot& row, const SlotNames<OperationsTag>& option) noexcept {
    row.operations = option.list;
}
constexpr void apply(Slot& row, const SlotNames<EventsTag>& option) noexcept { row.events = option.list; }

} // namespace detail

constexpr detail::SlotNumber<detail::NodesTag> nodes(std::uint32_t n) noexcept { return {n}; }
constexpr detail::SlotNumber<detail::DataTag> data_bytes(std::uint32_t n) noexcept { return {n}; }
constexpr detail::SlotNumber<detail::DepthTag> depth(std::uint32_t n) noexcept { return {n}; }
constexpr detail::SlotNumber<detail::CommandsTag> command_slots(std::uint32_t n) noexcept { return {n}; }
constexpr detail::SlotNumber<detail::TimersTag> timers(std::uint32_t n) noexcept { return {n}; }
/// The components, operations and events that what is loaded may name.
template <class... Names>
constexpr detail::SlotNames<detail::PeersTag> peers(const Names&... each) {
    return {names(each...)};
}
template <class... Names>
constexpr detail::SlotNames<detail::OperationsTag> operations(const Names&... each) {
    return {names(each...)};
}
template <class... Names>
constexpr detail::SlotNames<detail::EventsTag> events(const Names&... each) {
    return {names(each...)};
}
template <class... Options>
constexpr Slot slot(const Options&... options) {
    Slot row;
    (detail::apply(row, options), ...);
    return row;
}

/// A state machine table that drives a component; it runs in the component's activity.
template <std::size_t S, std::size_t T>
constexpr BehaviourRow behaviour(std::string_view component, const StateMachine<S, T>& machine) noexcept {
    return {component, machine.view(), {}};
}
/// Room and reach for a behaviour that is loaded while the machine runs.
constexpr BehaviourRow behaviour(std::string_view component, const Slot& slot) noexcept {
    return {component, {}, slot};
}

} // namespace tappet
