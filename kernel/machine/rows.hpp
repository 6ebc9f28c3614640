// The rows of a machine table as plain data, and the words that spell them. Nothing here is checked:
// kernel/machine/check.hpp reads the finished table.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/component/component.hpp"
#include "kernel/exchange/ring.hpp"
#include "kernel/statechart/rows.hpp"

#include <array>
#include <concepts>
#include <cstdint>
#include <string_view>

namespace tappet {

// ---- components

struct PropertyRow {
    std::string_view name{};
    PropertySetting setting;
};

struct DeviceName {
    std::string_view name{};
};
/// The logical name of the device that a driver component drives; board/ says what stands behind it.
constexpr DeviceName device(std::string_view name) noexcept { return {name}; }

/// A property's value in this machine.
constexpr PropertyRow set(std::string_view name, bool value) {
    return {name, {PropertySetting::Kind::truth, 0, value ? 1 : 0}};
}
template <std::integral T>
constexpr PropertyRow set(std::string_view name, T value) {
    return {name, {PropertySetting::Kind::whole, 0, static_cast<std::int64_t>(value)}};
}
template <std::floating_point T>
constexpr PropertyRow set(std::string_view name, T value) {
    return {name, {PropertySetting::Kind::real, static_cast<double>(value), 0}};
}
template <class Rep, class Period>
constexpr PropertyRow set(std::string_view name, std::chrono::duration<Rep, Period> value) {
    return {name, {PropertySetting::Kind::duration, 0, Duration{value}.count()}};
}

struct ComponentRow {
    static constexpr std::size_t max_settings = 24;
    std::string_view name{};
    const ComponentType* type = nullptr;
    std::string_view device{};
    Bounded<PropertyRow, max_settings> settings{};
    bool too_many_settings = false;
};

namespace detail {

constexpr void apply(ComponentRow& row, DeviceName option) noexcept { row.device = option.name; }
constexpr void apply(ComponentRow& row, const PropertyRow& option) noexcept {
    row.too_many_settings |= !row.settings.push(option);
}

} // namespace detail

template <class T, class... Options>
constexpr ComponentRow component(std::string_view name, const Options&... options) {
    ComponentRow row{.name = name, .type = &component_type<T>};
    (detail::apply(row, options), ...);
    return row;
}

// ---- activities

enum class Trigger : std::uint8_t { every, on_work, on_device, background };
enum class WhenLate : std::uint8_t { count, stop };

struct ActivityRow {
    static constexpr std::size_t max_runs = 64;
    static constexpr std::size_t default_stack_bytes = 64 * 1024;
    std::string_view name{};
    Trigger trigger = Trigger::background;
    Duration period{};          ///< of every; of background: how often it looks
    std::string_view device{};  ///< of on_device: the component whose device wakes it
    std::int64_t at_most_n = 1; ///< sporadic activities: at most n wakes ...
    Duration at_most_per{};     ///< ... in any window of this length
    Duration deadline_after{};  ///< zero: the period
    Duration budget_each{};     ///< processor time of one cycle, synchronous reactions included
    bool real_time = true;
    WhenLate when_late = WhenLate::count;
    std::size_t stack = default_stack_bytes;
    Bounded<std::string_view, max_runs> runs{};
    bool too_many_runs = false;
    bool has_trigger = false;
    std::string_view twice{}; ///< the option that the row was given twice

    [[nodiscard]] constexpr Duration shortest_period() const noexcept {
        return trigger == Trigger::every ? period : at_most_per;
    }
    [[nodiscard]] constexpr Duration deadline() const noexcept {
        return deadline_after.count() != 0 ? deadline_after : shortest_period();
    }
    [[nodiscard]] constexpr bool periodic() const noexcept {
        return trigger == Trigger::every || trigger == Trigger::background;
    }
};

struct TriggerOption {
    Trigger trigger;
    Duration period;
    std::string_view device{};
};
/// Periodic. Without not_real_time it needs a budget; its deadline is the period unless stated.
constexpr TriggerOption every(Duration period) noexcept { return {Trigger::every, period, {}}; }
/// Sporadic: runs when a message, a connection that wakes, or a timer of its components asks. Needs at_most.
constexpr TriggerOption on_work() noexcept { return {Trigger::on_work, {}, {}}; }
/// Sporadic: runs when the device of this component is ready. Needs at_most.
constexpr TriggerOption on_device(std::string_view component) noexcept {
    return {Trigger::on_device, {}, component};
}

struct AtMost {
    std::int64_t n;
    Duration per;
};
/// At most n wakes in any window of this length: what the schedulability analysis believes.
constexpr AtMost at_most(std::int64_t n, Duration per) noexcept { return {n, per}; }

struct Budget {
    Duration each;
};
constexpr Budget budget(Duration each) noexcept { return {each}; }
struct Deadline {
    Duration after;
};
constexpr Deadline deadline(Duration after) noexcept { return {after}; }
struct NotRealTime {};
/// May block; runs below every real-time activity, without budget or deadline.
inline constexpr NotRealTime not_real_time{};
struct StackBytes {
    std::size_t bytes;
};
constexpr StackBytes stack(std::size_t bytes) noexcept { return {bytes}; }
struct StopWhenLate {};
/// A missed deadline stops the machine; without this it is counted and reported.
inline constexpr StopWhenLate stop_when_late{};

struct Runs {
    Bounded<std::string_view, ActivityRow::max_runs> names{};
    bool too_many = false;
};
template <class... Names>
constexpr Runs runs(const Names&... names) {
    Runs row;
    ((row.too_many |= !row.names.push(std::string_view{names})), ...);
    return row;
}

namespace detail {

constexpr void give(ActivityRow& row, std::string_view option, bool is_given) noexcept {
    if (is_given && row.twice.empty()) row.twice = option;
}
constexpr void apply(ActivityRow& row, const TriggerOption& option) noexcept {
    give(row, "a trigger", row.has_trigger);
    row.trigger = option.trigger == Trigger::every && !row.real_time ? Trigger::background : option.trigger;
    row.period = option.period;
    row.device = option.device;
    row.has_trigger = true;
}
constexpr void apply(ActivityRow& row, AtMost option) noexcept {
    give(row, "at_most", row.at_most_per != Duration::zero());
    row.at_most_n = option.n;
    row.at_most_per = option.per;
}
constexpr void apply(ActivityRow& row, Budget option) noexcept {
    give(row, "a budget", row.budget_each != Duration::zero());
    row.budget_each = option.each;
}
constexpr void apply(ActivityRow& row, Deadline option) noexcept {
    give(row, "a deadline", row.deadline_after != Duration::zero());
    row.deadline_after = option.after;
}
constexpr void apply(ActivityRow& row, NotRealTime) noexcept {
    row.real_time = false;
    if (row.trigger == Trigger::every) row.trigger = Trigger::background;
}
constexpr void apply(ActivityRow& row, StackBytes option) noexcept { row.stack = option.bytes; }
constexpr void apply(ActivityRow& row, StopWhenLate) noexcept { row.when_late = WhenLate::stop; }
constexpr void apply(ActivityRow& row, const Runs& option) noexcept {
    give(row, "runs", !row.runs.empty());
    row.runs = option.names;
    row.too_many_runs = option.too_many;
}

} // namespace detail

template <class... Options>
constexpr ActivityRow activity(std::string_view name, const Options&... options) {
    ActivityRow row{.name = name};
    (detail::apply(row, options), ...);
    return row;
}

// ---- connections

struct ConnectionRow {
    std::string_view from{};
    std::string_view to{};
    bool buffered = false;
    std::size_t capacity = 0;
    Overflow overflow = Overflow::reject;
    Duration max_age{};
    WhenStale when_stale = WhenStale::hold;
    double substitute_value = 0;
    bool has_substitute = false;
    bool wakes_reader = false;
    bool delayed_step = false;
};

struct StaleAfter {
    Duration age;
};
/// A value older than this is stale; hold, substitute(x) or stop_machine say what the reader then gets.
constexpr StaleAfter stale_after(Duration age) noexcept { return {age}; }
inline constexpr WhenStale hold = WhenStale::hold;
inline constexpr WhenStale stop_machine = WhenStale::stop;
struct Substitute {
    double value;
};
/// What the reader gets instead of a stale or never written value (arithmetic types).
constexpr Substitute substitute(double value) noexcept { return {value}; }
struct Wakes {};
/// Each write wakes the reader's activity.
inline constexpr Wakes wakes{};
struct Delayed {};
/// The reader sees the value of the previous cycle: breaks a data-flow cycle inside one activity.
inline constexpr Delayed delayed{};
inline constexpr Overflow reject_newest = Overflow::reject;
inline constexpr Overflow drop_oldest = Overflow::drop_oldest;

namespace detail {

constexpr void apply(ConnectionRow& row, StaleAfter option) noexcept { row.max_age = option.age; }
constexpr void apply(ConnectionRow& row, WhenStale option) noexcept { row.when_stale = option; }
constexpr void apply(ConnectionRow& row, Substitute option) noexcept {
    row.when_stale = WhenStale::substitute;
    row.substitute_value = option.value;
    row.has_substitute = true;
}
constexpr void apply(ConnectionRow& row, Wakes) noexcept { row.wakes_reader = true; }
constexpr void apply(ConnectionRow& row, Delayed) noexcept { row.delayed_step = true; }
constexpr void apply(ConnectionRow& row, Overflow option) noexcept { row.overflow = option; }

} // namespace detail

/// The last value of an output, for an input.
template <class... Options>
constexpr ConnectionRow data(std::string_view from, std::string_view to, const Options&... options) {
    ConnectionRow row{.from = from, .to = to};
    (detail::apply(row, options), ...);
    return row;
}

/// Every value of a buffered output, in order, for a buffered input; at most Capacity wait.
template <std::size_t Capacity, class... Options>
constexpr ConnectionRow buffer(std::string_view from, std::string_view to, const Options&... options) {
    ConnectionRow row{.from = from, .to = to, .buffered = true, .capacity = Capacity};
    (detail::apply(row, options), ...);
    return row;
}

// ---- reactions

struct ReactionTarget {
    std::string_view operation{};
    bool synchronous = false;
    std::uint32_t quota = 8;
};
struct Queue {
    std::uint32_t n;
};
/// How many unserved emissions of this row may wait; one more is lost and counted. Eight unless stated.
constexpr Queue queue(std::uint32_t n) noexcept { return {n}; }

/// Asynchronous: in the receiver's engine, with the arguments of the emission.
constexpr ReactionTarget tell(std::string_view operation, Queue waiting = {8}) noexcept {
    return {operation, false, waiting.n};
}
/// Synchronous: in the emitter, here and now.
constexpr ReactionTarget call(std::string_view operation) noexcept { return {operation, true, 0}; }

struct ReactionRow {
    std::string_view event{};
    ReactionTarget target;
};
constexpr ReactionRow when(std::string_view event, ReactionTarget target) noexcept { return {event, target}; }

// ---- behaviours

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
