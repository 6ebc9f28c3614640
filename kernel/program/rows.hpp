// How a program is spelled in C++: nodes and arcs whose actions and conditions are member functions of the
// component (thesis fig. 5.2).
//
//     inline constexpr auto homing = program<Axis>("homing",
//         graph(node<&Axis::release_brake>("release"),
//               node<&Axis::creep>("creep", repeated, fails_to("brake")),
//               node<&Axis::apply_brake>("brake")),
//         arcs(arc("release", "creep"),
//              arc<&Axis::at_switch>("creep", program_end),
//              arc("creep", "brake", timeout(5s)),
//              arc("brake", program_end)));
//     static_assert(check(homing).empty()); // kernel/program/check_rows.hpp
//
// It begins at its first node; a node's arcs are asked in the order of their rows. A node without an open arc
// is waited at, one without any arc for ever.
#pragma once

#include "kernel/base/nearest.hpp"
#include "kernel/base/text.hpp"
#include "kernel/program/interpreter.hpp"
#include "kernel/program/value_access.hpp"

#include <array>
#include <type_traits>

namespace tappet {

/// Where the last arc of a program leads.
inline constexpr std::string_view program_end{};

struct ProgramNodeRow {
    std::string_view name{};
    Primitive action = nullptr; ///< null: it only asks its arcs
    TypeId component = nullptr; ///< of the action
    std::string_view on_error{};
    bool handles_error = false;
    bool repeats = false;
    bool yields = false;
};

struct ProgramArcRow {
    std::string_view from{};
    std::string_view to{};
    Primitive condition = nullptr; ///< null: always true
    TypeId component = nullptr;
    Duration after{}; ///< zero: no time-out
};

namespace detail {

template <class>
struct ProgramMember {
    static constexpr bool is_good = false;
    using Component = void;
};
template <class R, class C>
struct ProgramMember<R (C::*)() noexcept TAPPET_REALTIME> {
    static constexpr bool is_good = true;
    using Result = R;
    using Component = C;
};
template <class R, class C>
struct ProgramMember<R (C::*)() const noexcept TAPPET_REALTIME> {
    static constexpr bool is_good = true;
    using Result = R;
    using Component = const C;
};

template <auto Function>
ActionResult program_action(ProgramContext& context, const Instruction&, std::byte*, const std::byte*,
                            const std::byte*) noexcept TAPPET_REALTIME {
    using Of = ProgramMember<decltype(Function)>;
    auto& component = *static_cast<typename Of::Component*>(context.component);
    if constexpr (std::is_void_v<typename Of::Result>) {
        (component.*Function)();
        return ActionResult::done;
    } else if constexpr (std::is_same_v<typename Of::Result, bool>) {
        return (component.*Function)() ? ActionResult::done : ActionResult::failed;
    } else {
        return (component.*Function)();
    }
}
template <auto Function>
ActionResult program_condition(ProgramContext& context, const Instruction&, std::byte* to, const std::byte*,
                               const std::byte*) noexcept TAPPET_REALTIME {
    using Of = ProgramMember<decltype(Function)>;
    store_value<bool>(to, (static_cast<typename Of::Component*>(context.component)->*Function)());
    return ActionResult::done;
}

struct Repeated {};
struct Yielding {};
struct FailsTo {
    std::string_view node;
};
struct ProgramTimeout {
    Duration time;
};
constexpr void apply(ProgramNodeRow& row, Repeated) noexcept { row.repeats = true; }
constexpr void apply(ProgramNodeRow& row, Yielding) noexcept { row.yields = true; }
constexpr void apply(ProgramNodeRow& row, FailsTo to) noexcept {
    row.on_error = to.node, row.handles_error = true;
}
constexpr void apply(ProgramArcRow& row, ProgramTimeout timeout) noexcept { row.after = timeout.time; }

} // namespace detail

/// The node's action is executed in each step in which the program waits there.
inline constexpr detail::Repeated repeated{};
/// The node's arcs are asked from the next step on.
inline constexpr detail::Yielding yielding{};
/// The node at which the program goes on when the action fails.
constexpr detail::FailsTo fails_to(std::string_view node) noexcept { return {node}; }
/// The arc is open when so much time has passed since its node was entered, and its condition holds.
constexpr detail::ProgramTimeout timeout(Duration time) noexcept { return {time}; }

/// A node whose action is a member function `void f()`, `bool f()`, of which false is a failure, or
/// `ActionResult f()`, noexcept TAPPET_REALTIME.
template <auto Action, class... Options>
constexpr ProgramNodeRow node(std::string_view name, Options... options) noexcept {
    using Of = detail::ProgramMember<decltype(Action)>;
    static_assert(Of::is_good, "an action of a program is a member function without arguments, declared "
                               "noexcept TAPPET_REALTIME: it runs in the real-time activity");
    static_assert(std::is_void_v<typename Of::Result> || std::is_same_v<typename Of::Result, bool> ||
                      std::is_same_v<typename Of::Result, ActionResult>,
                  "an action of a program returns void, bool or ActionResult");
    ProgramNodeRow row{.name = name,
                       .action = &detail::program_action<Action>,
                       .component = type_id<std::remove_const_t<typename Of::Component>>};
    (detail::apply(row, options), ...);
    return row;
}
/// A node that only asks its arcs.
template <class... Options>
constexpr ProgramNodeRow node(std::string_view name, Options... options) noexcept {
    ProgramNodeRow row{.name = name};
    (detail::apply(row, options), ...);
    return row;
}

/// `Condition`: a member function `bool f()` noexcept TAPPET_REALTIME, which changes nothing.
template <auto Condition, class... Options>
constexpr ProgramArcRow arc(std::string_view from, std::string_view to, Options... options) noexcept {
    using Of = detail::ProgramMember<decltype(Condition)>;
    static_assert(Of::is_good && std::is_same_v<typename Of::Result, bool>,
                  "a condition of a program is a member function `bool f()`, declared noexcept "
                  "TAPPET_REALTIME: it runs in the real-time activity");
    ProgramArcRow row{.from = from,
                      .to = to,
                      .condition = &detail::program_condition<Condition>,
                      .component = type_id<std::remove_const_t<typename Of::Component>>};
    (detail::apply(row, options), ...);
    return row;
}
template <class... Options>
constexpr ProgramArcRow arc(std::string_view from, std::string_view to, Options... options) noexcept {
    ProgramArcRow row{.from = from, .to = to};
    (detail::apply(row, options), ...);
    return row;
}

template <class... Nodes>
constexpr std::array<ProgramNodeRow, sizeof...(Nodes)> graph(const Nodes&... each) noexcept {
    return {each...};
}
template <class... Arcs>
constexpr std::array<ProgramArcRow, sizeof...(Arcs)> arcs(const Arcs&... each) noexcept {
    return {each...};
}

/// Nodes of one program that is spelled in C++: its check keeps a mark for each.
inline constexpr std::size_t max_program_nodes = 1024;

/// A view of a program as it is spelled, and of what it became.
struct ProgramSpelling {
    std::string_view name{};
    TypeId component = nullptr;
    std::span<const ProgramNodeRow> nodes{};
    std::span<const ProgramArcRow> arcs{};
    ProgramTables tables{};

    /// no_node: no node has this name.
    [[nodiscard]] constexpr NodeIndex find(std::string_view node) const noexcept {
        if (node == program_end) return end_node;
        for (std::size_t i = 0; i < nodes.size(); ++i)
            if (nodes[i].name == node) return static_cast<NodeIndex>(i);
        return no_node;
    }
};

/// A program as it is spelled; what it became as a flat table is in tables().
template <std::size_t N, std::size_t A>
struct ProgramTable {
    static constexpr std::size_t value_bytes = data_alignment;

    std::string_view name{};
    TypeId component = nullptr;
    std::array<ProgramNodeRow, N> spelled_nodes{};
    std::array<ProgramArcRow, A> spelled_arcs{};

    std::array<Instruction, N + A> instructions{};
    std::array<ConditionRow, A> conditions{};
    std::array<NodeRow, N> nodes{};
    std::array<ArcRow, A> arcs{};
    std::array<ProgramRow, 1> programs{};
    /// The times of the arcs; after them, in the data, the answer of a condition.
    std::array<std::byte, A * value_bytes> image{};

    /// Views this table, which therefore stays where it is.
    [[nodiscard]] constexpr ProgramTables tables() const noexcept {
        constexpr auto constants = static_cast<DataOffset>(A * value_bytes);
        return {
            .instructions = instructions,
            .conditions = conditions,
            .nodes = nodes,
            .arcs = arcs,
            .programs = programs,
            .image = image,
            .layout = {constants, constants, constants, static_cast<DataOffset>(constants + value_bytes)}};
    }
    [[nodiscard]] constexpr ProgramSpelling spelling() const noexcept {
        return {name, component, spelled_nodes, spelled_arcs, tables()};
    }
};

/// Names of nodes that do not exist lead into error; check() says so.
template <class Component, std::size_t N, std::size_t A>
constexpr ProgramTable<N, A> program(std::string_view name, const std::array<ProgramNodeRow, N>& nodes,
                                     const std::array<ProgramArcRow, A>& arcs) noexcept {
    static_assert(N > 0, "a program has a node");
    static_assert(N <= max_program_nodes && (A + 1) * data_alignment < no_data,
                  "a program of a C++ table has 1024 nodes and some thousand arcs at most; split it");
    ProgramTable<N, A> table{
        .name = name, .component = type_id<Component>, .spelled_nodes = nodes, .spelled_arcs = arcs};
    const ProgramSpelling spelling{name, type_id<Component>, nodes, arcs, {}};
    constexpr auto answer = static_cast<DataOffset>(A * data_alignment);
    std::uint16_t placed = 0;
    for (std::size_t n = 0; n < N; ++n) {
        const ProgramNodeRow& spelled = nodes[n];
        NodeRow& row = table.nodes[n];
        row.first = static_cast<std::uint16_t>(n);
        row.count = spelled.action != nullptr ? 1 : 0;
        table.instructions[n].run = spelled.action;
        row.repeats = spelled.repeats, row.yields = spelled.yields;
        if (spelled.handles_error) row.on_error = spelling.find(spelled.on_error);
        row.first_arc = placed;
        for (std::size_t a = 0; a < A; ++a) {
            if (arcs[a].from != spelled.name) continue;
            table.instructions[N + a].run = arcs[a].condition;
            table.instructions[N + a].to = answer;
            table.conditions[a].first = static_cast<std::uint16_t>(N + a);
            table.conditions[a].count = arcs[a].condition != nullptr ? 1 : 0;
            table.conditions[a].result = answer;
            ArcRow& arc = table.arcs[placed++];
            if (arcs[a].condition != nullptr) arc.condition = static_cast<ConditionIndex>(a);
            arc.to = spelling.find(arcs[a].to);
            if (arcs[a].after == Duration::zero()) continue;
            arc.after = static_cast<DataOffset>(a * data_alignment);
            store_value(table.image.data() + arc.after, arcs[a].after);
        }
        row.arcs = static_cast<std::uint16_t>(placed - row.first_arc);
        row.line = 0;
    }
    table.programs[0] = {name, 0, static_cast<NodeIndex>(N), true};
    return table;
}

} // namespace tappet
