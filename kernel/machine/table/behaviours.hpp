// Behaviour rows: the state machine, program or script that drives a component, or the room kept for one that
// is loaded later.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/script/unit.hpp"
#include "kernel/statechart/execution.hpp"
#include "kernel/statechart/rows.hpp"

#include <concepts>
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
    std::uint32_t text_bytes = 0; ///< of the script; 0: as much as its nodes usually need
    std::uint32_t trial = 20;     ///< so many steps in which it works an error brings the old one back
    std::string_view angle{};     ///< "component.output" in degrees, whose angle a loading may wait for
    Bounded<std::string_view, max_names> peers{};      ///< components
    Bounded<std::string_view, max_names> operations{}; ///< component.operation
    Bounded<std::string_view, max_names> events{};     ///< component.event
};

/// What happens when a behaviour is in error and no parent handles it.
enum class OnError : std::uint8_t {
    stop_machine, ///< it is reported, and the machine stops safely
    report,       ///< it stands still and is reported
    go_on         ///< the failing statement is passed over (thesis 5.1.2)
};

struct BehaviourOptions {
    bool reactive = false;        ///< thesis 5.2.2: neither run programs nor conditions in a step
    bool escalates = false;       ///< a child in error puts its parent in error
    std::uint32_t statements = 0; ///< in one step; 0: default_statements
    OnError on_error = OnError::stop_machine;
};

/// A bound that only guards: no program that was checked comes near it in one step.
inline constexpr std::uint32_t default_statements = 1000;

/// Native code of one type of a unit.
struct BehaviourCode {
    ProgramCode code{};
    StateMachineFast fast{};
};

struct BehaviourRow {
    std::string_view component{};
    BehaviourType type{};         ///< of a C++ table; script and slot have none
    BehaviourInstance instance{}; ///< the only one of a C++ table
    const ScriptUnit* script = nullptr;
    std::span<const BehaviourCode> code{}; ///< of each type; empty: they stand in memory
    Slot slot{};
    bool reserves = false; ///< it is a slot
    BehaviourOptions options{};

    [[nodiscard]] constexpr bool is_slot() const noexcept { return reserves; }
    /// It runs something from the start: whatever is no slot, and a slot that begins with what was compiled.
    [[nodiscard]] constexpr bool is_driven() const noexcept {
        return script != nullptr || !instance.name.empty();
    }
    /// What it runs from the start, as one form; of a row that lies where it stays. Empty of a slot that
    /// begins with nothing.
    [[nodiscard]] constexpr ScriptUnit unit() const noexcept {
        if (script != nullptr) return *script;
        if (!is_driven()) return {};
        return {.name = type.name, .types = {&type, 1}, .instances = {&instance, 1}};
    }
};

/// A list of names, 16 at most.
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
struct TextTag {};
struct TrialTag {};
struct SlotAngle {
    std::string_view output;
};

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
constexpr void apply(Slot& row, SlotNumber<TextTag> option) noexcept { row.text_bytes = option.value; }
constexpr void apply(Slot& row, SlotNumber<TrialTag> option) noexcept { row.trial = option.value; }
constexpr void apply(Slot& row, SlotAngle option) noexcept { row.angle = option.output; }

struct Reactive {};
struct Escalates {};
struct StatementBound {
    std::uint32_t statements;
};
constexpr void apply(BehaviourOptions& row, Reactive) noexcept { row.reactive = true; }
constexpr void apply(BehaviourOptions& row, Escalates) noexcept { row.escalates = true; }
constexpr void apply(BehaviourOptions& row, StatementBound bound) noexcept {
    row.statements = bound.statements;
}
constexpr void apply(BehaviourOptions& row, OnError what) noexcept { row.on_error = what; }
template <class Option>
constexpr void apply(BehaviourRow& row, const Option& option) noexcept {
    if constexpr (std::same_as<Option, Slot>)
        row.slot = option, row.reserves = true;
    else
        apply(row.options, option);
}

} // namespace detail

/// Instructions of what is loaded.
constexpr detail::SlotNumber<detail::NodesTag> nodes(std::uint32_t n) noexcept { return {n}; }
/// Of its variables and of arguments under way.
constexpr detail::SlotNumber<detail::DataTag> data_bytes(std::uint32_t n) noexcept { return {n}; }
/// Of composite states and child machines.
constexpr detail::SlotNumber<detail::DepthTag> depth(std::uint32_t n) noexcept { return {n}; }
/// Commands that it sends.
constexpr detail::SlotNumber<detail::CommandsTag> command_slots(std::uint32_t n) noexcept { return {n}; }
/// Statements and transitions that wait for time.
constexpr detail::SlotNumber<detail::TimersTag> timers(std::uint32_t n) noexcept { return {n}; }
/// The components, operations and events that what is loaded may name.
template <class... Names>
constexpr detail::SlotNames<detail::PeersTag> peers(const Names&... each) {
    return {names(each...)};
}
/// Of its peers, as component.operation.
template <class... Names>
constexpr detail::SlotNames<detail::OperationsTag> operations(const Names&... each) {
    return {names(each...)};
}
/// Of its peers, as component.event.
template <class... Names>
constexpr detail::SlotNames<detail::EventsTag> events(const Names&... each) {
    return {names(each...)};
}
/// Characters of a script.
constexpr detail::SlotNumber<detail::TextTag> text_bytes(std::uint32_t n) noexcept { return {n}; }
/// A new behaviour must show that it works for so many steps in which it is told an event or a program of it
/// runs; one that nobody asks for anything stays on trial.
constexpr detail::SlotNumber<detail::TrialTag> trial(std::uint32_t steps) noexcept { return {steps}; }
/// The output, in degrees and in the slot's activity, whose angle a loading may wait for.
constexpr detail::SlotAngle angle_of(std::string_view output) noexcept { return {output}; }
/// Room for one behaviour that is loaded later.
template <class... Options>
constexpr Slot slot(const Options&... options) {
    Slot row;
    (detail::apply(row, options), ...);
    return row;
}

/// No run programs and no conditions in the engine's steps: it moves upon events and requests only.
inline constexpr detail::Reactive reactive_mode{};
/// A child machine in error puts its parent in error, which may have no other way to notice.
inline constexpr detail::Escalates escalates{};
/// At most so many statements in one step of the engine; what is left over goes on in the next.
constexpr detail::StatementBound at_most(std::uint32_t statements) noexcept { return {statements}; }
/// What an error that no parent handles does; it stops the machine unless stated.
constexpr OnError on_error(OnError what) noexcept { return what; }

/// A state machine table that drives a component; it runs in the component's activity. As an option of this
/// and of a script, slot(...) is room for another one that is loaded in its place while the machine runs;
/// what it begins with reaches no more than the slot does, so that it can be loaded again.
template <std::size_t S, std::size_t T, class... Options>
constexpr BehaviourRow behaviour(std::string_view component, const StateMachine<S, T>& machine,
                                 const Options&... options) noexcept {
    BehaviourRow row;
    row.component = component;
    row.type.machine = machine.view();
    row.type.name = row.type.machine.name;
    row.instance.name = row.type.name;
    (detail::apply(row, options), ...);
    return row;
}
/// A compiled script, or its tables as they are; `script` and `code`, which stands in the order of its types,
/// outlive the row.
template <class... Options>
constexpr BehaviourRow behaviour(std::string_view component, const ScriptUnit& script,
                                 std::span<const BehaviourCode> code, const Options&... options) noexcept {
    BehaviourRow row;
    row.component = component;
    row.script = &script;
    row.code = code;
    (detail::apply(row, options), ...);
    return row;
}
/// Room and reach for a behaviour that is loaded while the machine runs.
template <class... Options>
constexpr BehaviourRow behaviour(std::string_view component, const Slot& slot,
                                 const Options&... options) noexcept {
    BehaviourRow row;
    row.component = component;
    detail::apply(row, slot);
    (detail::apply(row, options), ...);
    return row;
}

} // namespace tappet
