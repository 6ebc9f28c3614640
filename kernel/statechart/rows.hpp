// The C++ notation of a state machine. Each word gives a plain struct; member functions become function
// pointers.
//
//     constexpr auto loom_cycle = state_machine<Loom>("loom_cycle",
//         states(
//             state("idle", initial, entry<&Loom::all_off>),
//             state("working"),
//             state("run_up", in("working"), initial, entry<&Loom::begin>, run<&Loom::hold_speed>),
//             state("weave", in("working"), run<&Loom::check>, exit<&Loom::stop_weft>),
//             state("safe", final, entry<&Loom::safe>)),
//         transitions(
//             transition("idle", "run_up", on("panel.start"), guard<&Loom::warm>.because("the oil is cold"),
//                        then<&Loom::count_start>),
//             transition("run_up", "weave", guard<&Loom::at_speed>),
//             transition("run_up", "safe", after(5s), because("the run-up took too long")),
//             transition("working", "safe", on("panel.emergency")),
//             internal("weave", on("panel.mark"), then<&Loom::mark>)));
//     static_assert(check(loom_cycle.view()).empty());
#pragma once

#include "kernel/base/row_option.hpp"
#include "kernel/statechart/table.hpp"

#include <array>
#include <type_traits>

namespace tappet {

namespace statechart {

template <class> struct Member {
    static constexpr bool real_time = false;
    using Result = struct NoResult;
    using Component = void;
};
template <class F, class C> struct Member<F C::*> : Member<void> {
    using Component = C;
};
template <class R, class C> struct Member<R (C::*)() noexcept TAPPET_REALTIME> {
    static constexpr bool real_time = true;
    using Result = R;
    using Component = C;
    using Object = C;
};
template <class R, class C> struct Member<R (C::*)() const noexcept TAPPET_REALTIME> {
    static constexpr bool real_time = true;
    using Result = R;
    using Component = C;
    using Object = const C;
};

template <auto Function, class Result> Result call(void* component) noexcept TAPPET_REALTIME {
    using Of = Member<decltype(Function)>;
    if constexpr (std::is_same_v<typename Of::Result, Result>)
        return (static_cast<typename Of::Object*>(component)->*Function)();
    else
        return Result(); // so that the assertion stays the only error
}

template <class Pointer> struct Bound {
    Pointer call = nullptr;
    TypeId component = nullptr;
};

template <auto Function, class Result> consteval auto bind() {
    using Of = Member<decltype(Function)>;
    static_assert(Of::real_time,
                  "a program or guard of a state machine is a member function without arguments, "
                  "declared noexcept TAPPET_REALTIME: it runs in the real-time activity");
    if constexpr (Of::real_time)
        static_assert(
            std::is_same_v<typename Of::Result, Result>,
            "a guard returns bool; an entry, exit, run or transition program returns void; the detail "
            "of a reason returns std::string_view");
    return Bound<Result (*)(void*) noexcept TAPPET_REALTIME>{&call<Function, Result>,
                                                             type_id<typename Of::Component>};
}

struct Entry : Bound<StateProgram> {};
struct Exit : Bound<StateProgram> {};
struct Run : Bound<StateProgram> {};
struct Handle : Bound<StateProgram> {};
struct Then : Bound<StateProgram> {};
struct Otherwise : Bound<StateProgram> {};
/// A guard or precondition, and the reason shown to people when it says no.
struct Asked : Bound<StateGuard> {
    GuardReason refusal{};
    std::string_view fault{}; ///< as `twice` of a row

    constexpr void give(std::string_view text) {
        if (text.empty()) fault = "empty reason";
        if (!refusal.text.empty()) fault = "reason of its guard";
        refusal.text = text;
    }
};
enum class AskedOf : std::uint8_t { transition, state };
template <AskedOf> struct Question : Asked {
    /// Sets the reason that `tappet-browse why` and the log show when an event is refused.
    [[nodiscard]] constexpr Question because(std::string_view text) const {
        Question told = *this;
        told.give(text);
        return told;
    }
    /// `detail` says which of several things is the reason: a member function; its text must be valid
    /// forever.
    template <auto detail> [[nodiscard]] constexpr Question because(std::string_view text) const {
        Question told = because(text);
        const auto words = bind<detail, std::string_view>();
        told.refusal.detail = words.call;
        if (words.component != component) told.fault = "component type";
        return told;
    }
};
using When = Question<AskedOf::transition>;
using Precondition = Question<AskedOf::state>;
struct OtherwiseTo {
    std::string_view state;
};
struct On {
    std::string_view event;
};
struct After {
    Duration time;
};

// A row takes each part once and belongs to one component type; violations are stored for the check to
// report.
using detail::give;
template <class Row, class Reference, class Pointer>
constexpr void give(Row& row, std::string_view part, Reference& place, const Bound<Pointer>& bound) {
    give(row, part, !place.empty());
    place = bound.call;
    if (row.component == nullptr)
        row.component = bound.component;
    else if (row.component != bound.component)
        give(row, "component type", true);
}
template <class Row>
constexpr void give(Row& row, std::string_view part, ConditionRef& place, const Asked& question) {
    give(row, part, place, static_cast<const Bound<StateGuard>&>(question));
    give(row, question.fault, !question.fault.empty());
    row.refusal = question.refusal;
}

} // namespace statechart

/// The role of a state.
enum StateRole : std::uint8_t { initial, final };

template <auto Function> inline constexpr statechart::Entry entry{statechart::bind<Function, void>()};
/// A function, not a variable like its neighbours: with `using namespace tappet`, a variable would be
/// ambiguous with the C library's exit.
template <auto Function> constexpr statechart::Exit exit() noexcept {
    return {statechart::bind<Function, void>()};
}
template <auto Function> inline constexpr statechart::Run run{statechart::bind<Function, void>()};
/// Runs after each run program that no transition followed, and when a guard refused an event.
template <auto Function> inline constexpr statechart::Handle handles{statechart::bind<Function, void>()};
/// Evaluated in addition to the guard of each transition that enters the state.
template <auto Function>
inline constexpr statechart::Precondition precondition{{{statechart::bind<Function, bool>()}}};
/// The transition program.
template <auto Function> inline constexpr statechart::Then then{statechart::bind<Function, void>()};
template <auto Function>
inline constexpr statechart::When guard{{{statechart::bind<Function, bool>()}}};
/// Runs when the guard of an event transition refuses; otherwise_to() names the state entered then (listing
/// 5.4, else).
template <auto Function>
inline constexpr statechart::Otherwise otherwise{statechart::bind<Function, void>()};
constexpr statechart::OtherwiseTo otherwise_to(std::string_view state) { return {state}; }
/// The region of the composite that contains this state: one state of each region is active.
constexpr RowOptionOnce<StateRow, std::string_view> region(std::string_view name) {
    return {&StateRow::region, name, "region(...)"};
}
/// Restores the states that were active when the composite target was last exited, see EntryKind.
inline constexpr EntryKind shallow_history = EntryKind::shallow_history;
inline constexpr EntryKind deep_history = EntryKind::deep_history;
/// The enclosing composite state.
constexpr RowOptionOnce<StateRow, std::string_view> in(std::string_view state) {
    return {&StateRow::parent, state, "in(...)"};
}
/// An event transition: "component.event", or "event" of the own component.
constexpr statechart::On on(std::string_view event) { return {event}; }
/// A time-out: time since the transition's source was entered.
constexpr statechart::After after(Duration time) { return {time}; }
/// The reason shown to the operator when the transition is taken.
constexpr RowOptionOnce<TransitionRow, std::string_view> because(std::string_view reason) {
    return {&TransitionRow::because, reason, "because(...)"};
}

namespace statechart {

using detail::apply;
constexpr void apply(StateRow& row, StateRole role) {
    bool& place = role == tappet::initial ? row.initial : row.final;
    give(row, role == tappet::initial ? "initial" : "final", place);
    place = true;
}
constexpr void apply(StateRow& row, const Entry& part) { give(row, "entry", row.entry, part); }
constexpr void apply(StateRow& row, Exit (*part)() noexcept) { give(row, "exit", row.exit, part()); }
constexpr void apply(StateRow& row, const Run& part) { give(row, "run", row.run, part); }
constexpr void apply(StateRow& row, const Handle& part) { give(row, "handle", row.handle, part); }
constexpr void apply(StateRow& row, const Precondition& part) {
    give(row, "precondition", row.precondition, part);
}

constexpr void apply(TransitionRow& row, On part) {
    give(row, "on(...)", row.on_event);
    row.on_event = true;
    row.event = part.event;
}
constexpr void apply(TransitionRow& row, After part) {
    give(row, "after(...)", row.timed);
    row.timed = true;
    row.after = part.time;
}
constexpr void apply(TransitionRow& row, const When& part) { give(row, "guard", row.guard, part); }
constexpr void apply(TransitionRow& row, const Then& part) { give(row, "then", row.then, part); }
constexpr void apply(TransitionRow& row, const Otherwise& part) {
    give(row, "otherwise", row.otherwise, part);
    row.has_otherwise = true;
}
constexpr void apply(TransitionRow& row, OtherwiseTo part) {
    give(row, "otherwise_to(...)", !row.otherwise_to.empty());
    row.otherwise_to = part.state;
    row.has_otherwise = true;
}
constexpr void apply(TransitionRow& row, EntryKind part) {
    give(row, "history", row.enters != EntryKind::initial);
    row.enters = part;
}

} // namespace statechart

template <class... Parts> constexpr StateRow state(std::string_view name, const Parts&... parts) {
    StateRow row{.name = name};
    (statechart::apply(row, parts), ...);
    return row;
}

template <class... Parts>
constexpr TransitionRow transition(std::string_view from, std::string_view to, const Parts&... parts) {
    TransitionRow row{.from = from, .to = to};
    (statechart::apply(row, parts), ...);
    return row;
}

/// A reaction to an event that exits and enters no state.
template <class... Parts> constexpr TransitionRow internal(std::string_view state, const Parts&... parts) {
    return transition(state, {}, parts...);
}

template <class... Rows> constexpr std::array<StateRow, sizeof...(Rows)> states(const Rows&... rows) {
    return {rows...};
}

template <class... Rows>
constexpr std::array<TransitionRow, sizeof...(Rows)> transitions(const Rows&... rows) {
    return {rows...};
}

/// S states, T transitions.
template <std::size_t S, std::size_t T> struct StateMachine {
    std::string_view name;
    TypeId component;
    std::array<StateRow, S> states;
    std::array<TransitionRow, T> transitions;

    [[nodiscard]] constexpr StateMachineTable view() const { return {name, states, transitions, component}; }
};

template <class Component, std::size_t S, std::size_t T>
constexpr StateMachine<S, T> state_machine(std::string_view name, const std::array<StateRow, S>& states,
                                           const std::array<TransitionRow, T>& transitions = {}) {
    return {name, type_id<Component>, states, transitions};
}

} // namespace tappet
