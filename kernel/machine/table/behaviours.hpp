// Behaviour rows: the state machine, program or script that drives a component, or the room kept for one that
// is loaded later.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/base/row_option.hpp"
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

using SlotNumber = RowOption<Slot, std::uint32_t>;
using SlotNames = RowOption<Slot, Bounded<std::string_view, Slot::max_names>>;

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
constexpr detail::SlotNumber nodes(std::uint32_t n) noexcept { return {&Slot::nodes, n}; }
/// Of its variables and of arguments under way.
constexpr detail::SlotNumber data_bytes(std::uint32_t n) noexcept { return {&Slot::data_bytes, n}; }
/// Of composite states and child machines.
constexpr detail::SlotNumber depth(std::uint32_t n) noexcept { return {&Slot::depth, n}; }
/// Commands that it sends.
constexpr detail::SlotNumber command_slots(std::uint32_t n) noexcept { return {&Slot::command_slots, n}; }
/// Statements and transitions that wait for time.
constexpr detail::SlotNumber timers(std::uint32_t n) noexcept { return {&Slot::timers, n}; }
/// The components, operations and events that what is loaded may name.
template <class... Names>
constexpr detail::SlotNames peers(const Names&... each) {
    return {&Slot::peers, names(each...)};
}
/// Of its peers, as component.operation.
template <class... Names>
constexpr detail::SlotNames operations(const Names&... each) {
    return {&Slot::operations, names(each...)};
}
/// Of its peers, as component.event.
template <class... Names>
constexpr detail::SlotNames events(const Names&... each) {
    return {&Slot::events, names(each...)};
}
/// Characters of a script.
constexpr detail::SlotNumber text_bytes(std::uint32_t n) noexcept { return {&Slot::text_bytes, n}; }
/// A new behaviour must show that it works for so many steps in which it is told an event or a program of it
/// runs; one that nobody asks for anything stays on trial.
constexpr detail::SlotNumber trial(std::uint32_t steps) noexcept { return {&Slot::trial, steps}; }
/// The output, in degrees and in the slot's activity, whose angle a loading may wait for.
constexpr RowOption<Slot, std::string_view> angle_of(std::string_view output) noexcept {
    return {&Slot::angle, output};
}
/// Room for one behaviour that is loaded later.
template <class... Options>
constexpr Slot slot(const Options&... options) {
    Slot row;
    (detail::apply(row, options), ...);
    return row;
}

/// No run programs and no conditions in the engine's steps: it moves upon events and requests only.
inline constexpr RowOption reactive_mode{&BehaviourOptions::reactive, true};
/// A child machine in error puts its parent in error, which may have no other way to notice.
inline constexpr RowOption escalates{&BehaviourOptions::escalates, true};
/// At most so many statements in one step of the engine; what is left over goes on in the next.
constexpr RowOption<BehaviourOptions, std::uint32_t> at_most(std::uint32_t statements) noexcept {
    return {&BehaviourOptions::statements, statements};
}
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
