// Behaviour rows: the state machine, program or script that drives a component, or the memory reserved for
// one that is loaded later.
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

/// The resources of a behaviour that is loaded later. They are reserved at start-up, because nothing is
/// allocated at run time.
struct Slot {
    static constexpr std::size_t max_names = 16;
    std::uint32_t nodes = 0;
    std::uint32_t data_bytes = 0;
    std::uint32_t depth = 0;
    std::uint32_t command_slots = 0;
    std::uint32_t timers = 0;
    std::uint32_t text_bytes = 0; ///< for the script's text; 0: the usual amount for its nodes
    std::uint32_t trial = 20;     ///< active steps within which an error restores the old behaviour
    std::string_view angle{};     ///< "component.output" in degrees: a loading may wait for an angle of it
    Bounded<std::string_view, max_names> peers{};      ///< components
    Bounded<std::string_view, max_names> operations{}; ///< component.operation
    Bounded<std::string_view, max_names> events{};     ///< component.event
};

/// Effect of an error in a behaviour that no parent handles.
enum class OnError : std::uint8_t {
    stop_machine, ///< the error is reported, and the machine stops safely
    report,       ///< the behaviour halts, and the error is reported
    go_on         ///< the failing statement is skipped (thesis 5.1.2)
};

struct BehaviourOptions {
    bool reactive = false;        ///< thesis 5.2.2: a step executes no run programs and no conditions
    bool escalates = false;       ///< a child in error puts its parent in error
    std::uint32_t statements = 0; ///< in one step; 0: default_statements
    OnError on_error = OnError::stop_machine;
};

/// A guard only: no checked program comes near this number of statements in one step.
inline constexpr std::uint32_t default_statements = 1000;

/// Native code of one type of a unit.
struct BehaviourCode {
    ProgramCode code{};
    StateMachineFast fast{};
};

struct BehaviourRow {
    std::string_view component{};
    BehaviourType type{};         ///< of a C++ table; a script or a slot has none
    BehaviourInstance instance{}; ///< the only instance of a C++ table
    const ScriptUnit* script = nullptr;
    std::span<const BehaviourCode> code{}; ///< one for each type; empty: they are interpreted
    Slot slot{};
    bool reserves = false; ///< it is a slot
    BehaviourOptions options{};

    [[nodiscard]] constexpr bool is_slot() const noexcept { return reserves; }
    /// Whether it drives the component from start-up: true for every row but a slot that starts empty.
    [[nodiscard]] constexpr bool is_driven() const noexcept {
        return script != nullptr || !instance.name.empty();
    }
    /// Returns what it drives the component with from start-up, as one unit; empty for a slot that starts
    /// empty. The row must stay at its address.
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

/// Instructions of the loaded behaviour.
constexpr detail::SlotNumber nodes(std::uint32_t n) noexcept { return {&Slot::nodes, n}; }
/// Bytes for its variables and for the arguments of running calls.
constexpr detail::SlotNumber data_bytes(std::uint32_t n) noexcept { return {&Slot::data_bytes, n}; }
/// Nesting depth of composite states and child machines.
constexpr detail::SlotNumber depth(std::uint32_t n) noexcept { return {&Slot::depth, n}; }
/// Commands that it sends.
constexpr detail::SlotNumber command_slots(std::uint32_t n) noexcept { return {&Slot::command_slots, n}; }
/// Statements and transitions that wait for time.
constexpr detail::SlotNumber timers(std::uint32_t n) noexcept { return {&Slot::timers, n}; }
/// The components that the loaded behaviour may name.
template <class... Names>
constexpr detail::SlotNames peers(const Names&... each) {
    return {&Slot::peers, names(each...)};
}
/// Operations of its peers, each as component.operation.
template <class... Names>
constexpr detail::SlotNames operations(const Names&... each) {
    return {&Slot::operations, names(each...)};
}
/// Events of its peers, each as component.event.
template <class... Names>
constexpr detail::SlotNames events(const Names&... each) {
    return {&Slot::events, names(each...)};
}
/// Characters of a script.
constexpr detail::SlotNumber text_bytes(std::uint32_t n) noexcept { return {&Slot::text_bytes, n}; }
/// The number of active steps in which a new behaviour must prove itself: steps in which an event reaches it
/// or one of its programs runs. A behaviour that receives no request stays on trial.
constexpr detail::SlotNumber trial(std::uint32_t steps) noexcept { return {&Slot::trial, steps}; }
/// The output, in degrees and in the slot's activity, for whose angle a loading may wait.
constexpr RowOption<Slot, std::string_view> angle_of(std::string_view output) noexcept {
    return {&Slot::angle, output};
}
/// Reserves memory for one behaviour that is loaded later.
template <class... Options>
constexpr Slot slot(const Options&... options) {
    Slot row;
    (detail::apply(row, options), ...);
    return row;
}

/// The engine's steps execute no run programs and no conditions: the machine reacts only to events and
/// requests.
inline constexpr RowOption reactive_mode{&BehaviourOptions::reactive, true};
/// A child machine in error puts its parent in error, which may have no other way to notice.
inline constexpr RowOption escalates{&BehaviourOptions::escalates, true};
/// At most this many statements in one step of the engine; the rest is executed in the next step.
constexpr RowOption<BehaviourOptions, std::uint32_t> at_most(std::uint32_t statements) noexcept {
    return {&BehaviourOptions::statements, statements};
}
/// Effect of an error that no parent handles. Default: it stops the machine.
constexpr OnError on_error(OnError what) noexcept { return what; }

/// A state machine table that drives a component; it runs in the component's activity. With the option
/// slot(...), which scripts take too, another behaviour can be loaded in its place while the machine runs.
/// The initial behaviour must then reach no more than the slot, so that it can be loaded again.
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
/// A compiled script, or its plain tables. `script` and `code` must outlive the row; `code` is in the order
/// of the script's types.
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
/// Reserves memory and reach for a behaviour that is loaded while the machine runs.
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
