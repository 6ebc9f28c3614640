// The verification model of a machine beside its table: a few variables, the effects of C++ programs and
// operations on them, the possible events of the world, and the properties that must hold. Plain rows; the
// Promela export combines them with the machine table and its state machines.
//
//     inline constexpr auto model = verification(
//         remembers("ready", 0, 1),
//         program<&Loom::enter_run_up>(emits("loom.allow_weft")),
//         operation("weft.on_release_angle", when_true("ready"), sets("ready = 0"),
//         emits("weft.open_valve")), happens("shaft.weft_opens", when_true("angle == 1"), sets("angle = 2")),
//         only_when("weft.open_valve", "!braking", "no weft is released while the shaft is braked"));
//
// Conditions and assignments are Promela over the names of remembers(...). "in_<component>_<state>" is true
// while that state is active, "settled_<activity>" while no message waits for that activity. Everything
// without a row is free: a C++ guard may be true or false, a C++ program changes no variable, and an event
// that nobody emits may come at any time.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/statechart/rows.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace tappet::chart {

enum class ModelKind : std::uint8_t {
    remembers, ///< a number with its first and its largest value
    program,   ///< the effect of a C++ program of a state machine
    guard,     ///< the result of a C++ guard
    operation, ///< the effect of an operation; the first of its rows whose condition holds applies
    happens,   ///< when an event of the world may come, and its effect
    always,    ///< an invariant: after every step
    only_when  ///< an invariant of an event: at every emission
};

struct ModelRow {
    static constexpr std::size_t max_emits = 8;
    ModelKind kind = ModelKind::always;
    std::string_view name{}; ///< variable, operation or event
    StateProgram program = nullptr;
    StateGuard guard = nullptr;
    std::string_view when{};
    std::string_view sets{};    ///< assignments, separated by semicolons
    std::string_view because{}; ///< the purpose of an invariant, in words
    Bounded<std::string_view, max_emits> emits{};
    unsigned first = 0;
    unsigned largest = 1;
};

namespace detail {

struct When {
    std::string_view text;
};
struct Sets {
    std::string_view text;
};
struct Emits {
    Bounded<std::string_view, ModelRow::max_emits> events;
};
constexpr void apply(ModelRow& row, When part) { row.when = part.text; }
constexpr void apply(ModelRow& row, Sets part) { row.sets = part.text; }
constexpr void apply(ModelRow& row, const Emits& part) { row.emits = part.events; }

template <class... Parts> constexpr ModelRow with(ModelRow row, const Parts&... parts) {
    (apply(row, parts), ...);
    return row;
}

} // namespace detail

constexpr detail::When when_true(std::string_view condition) { return {condition}; }
constexpr detail::Sets sets(std::string_view assignments) { return {assignments}; }
template <class... Names> constexpr detail::Emits emits(const Names&... events) {
    static_assert(sizeof...(Names) <= ModelRow::max_emits, "a row emits at most eight events");
    detail::Emits list;
    (static_cast<void>(list.events.push(std::string_view{events})), ...);
    return list;
}

constexpr ModelRow remembers(std::string_view name, unsigned first, unsigned largest) {
    return {.kind = ModelKind::remembers, .name = name, .first = first, .largest = largest};
}
template <auto Function, class... Parts> constexpr ModelRow program(const Parts&... parts) {
    return detail::with({.kind = ModelKind::program, .program = &statechart::call<Function, void>}, parts...);
}
template <auto Function> constexpr ModelRow says(std::string_view condition) {
    return {.kind = ModelKind::guard, .guard = &statechart::call<Function, bool>, .when = condition};
}
template <class... Parts> constexpr ModelRow operation(std::string_view name, const Parts&... parts) {
    return detail::with({.kind = ModelKind::operation, .name = name}, parts...);
}
template <class... Parts> constexpr ModelRow happens(std::string_view event, const Parts&... parts) {
    return detail::with({.kind = ModelKind::happens, .name = event}, parts...);
}
constexpr ModelRow always(std::string_view condition, std::string_view because) {
    return {.kind = ModelKind::always, .when = condition, .because = because};
}
constexpr ModelRow only_when(std::string_view event, std::string_view condition, std::string_view because) {
    return {.kind = ModelKind::only_when, .name = event, .when = condition, .because = because};
}

template <class... Rows> constexpr std::array<ModelRow, sizeof...(Rows)> verification(const Rows&... rows) {
    return {rows...};
}

} // namespace tappet::chart
