// A script that is compiled with the firmware: text and reach are constants, and so is what comes of them.
//
//     inline constexpr tappet::ScriptSource weft_source{"weft.osd", "StateMachine Weft { ... }"};  // by
//     tappet_script() inline constexpr auto weft_reach = tappet::script_reach<WeftInsertion>("weft"); inline
//     constexpr const tappet::ScriptUnit& weft_script = tappet::compiled_script<weft_source, weft_reach>;
#pragma once

#include "kernel/script/compile.hpp"

namespace tappet {

struct ScriptSource {
    std::string_view name{};
    std::string_view text{};
};

/// A component that a script reaches, by type and name.
template <class T>
constexpr Reachable reachable(std::string_view name, bool same_activity = true) noexcept {
    return {name, &component_type<T>, same_activity};
}

/// A reach that owns its list; the first is the component that the script drives.
template <std::size_t N>
struct ScriptReach {
    std::array<Reachable, N> components{};
    std::uint32_t statements_per_step = 0;

    [[nodiscard]] constexpr Reach view() const noexcept {
        Reach reach;
        reach.components = components;
        reach.statements_per_step = statements_per_step;
        return reach;
    }
};
template <class... R>
constexpr ScriptReach<sizeof...(R)> script_reach(const R&... each) noexcept {
    return {{each...}};
}

namespace script_detail {

struct Measured {
    Sentence fault{};
    bool out_of_room = false;
    ScriptSizes sizes{};
};

/// Twice the usual need: in a constant expression empty rows cost time too.
constexpr ScriptSizes measuring_room(std::uint32_t nodes, std::size_t components) noexcept {
    ScriptSizes most = script_sizes_for(nodes, 1024 + 4 * nodes, static_cast<std::uint32_t>(components));
    most.instructions = 4 * nodes;
    most.conditions = most.programs = most.transitions = nodes / 2 + 16;
    most.variables = most.links = most.captures = nodes / 8 + 32;
    most.states = nodes / 3 + 8;
    most.names = 10 * nodes + 512;
    return most;
}
template <ScriptSizes room>
consteval Measured measure_script(const ScriptSource& source, const Reach& peers) {
    ScriptBuffer<room> buffer{};
    const ScriptOutcome outcome = compile_into(source.text, source.name, peers, buffer.room());
    return {outcome.fault, outcome.out_of_room, outcome.good() ? outcome.sizes : ScriptSizes{}};
}
/// With a room that grows until the script finds place, or is too large for any.
template <const auto& Source, const auto& Peers, std::uint32_t nodes>
consteval Measured measure_within() {
    constexpr Measured measured =
        measure_script<measuring_room(nodes, Peers.components.size())>(Source, Peers.view());
    if constexpr (measured.out_of_room && nodes < max_script_nodes)
        return measure_within<Source, Peers, 2 * nodes>();
    else
        return measured;
}

template <const auto& Source, const auto& Peers>
inline constexpr Measured measured =
    measure_within<Source, Peers, static_cast<std::uint32_t>(Source.text.size() / 56 + 32)>();

template <ScriptSizes sizes>
struct StoredScript {
    ScriptBuffer<sizes> rows{};
    ScriptUnit unit{};

    constexpr StoredScript(const ScriptSource& source, const Reach& peers) {
        unit = compile_into(source.text, source.name, peers, rows.room()).unit;
    }
};

template <const auto& Source, const auto& Peers>
inline constexpr StoredScript<measured<Source, Peers>.sizes> stored{Source, Peers.view()};

/// Not defined: a compiler that prints no message objects prints the sentence as the argument of this name.
template <text sentence>
struct script_fault;
template <>
struct script_fault<text<0>{}> {};

template <const auto& Source, const auto& Peers>
struct CheckedScript {
    static constexpr const Sentence& fault = measured<Source, Peers>.fault;
#if defined(__clang__)
    static constexpr bool accepted = fault.empty();
    static_assert(accepted, fault);
#else
    static_assert(sizeof(script_fault<text<fault.size()>{fault.view()}>) != 0);
#endif
    static constexpr const ScriptUnit& unit = stored<Source, Peers>.unit;
};

} // namespace script_detail

/// The unit of a constant script; a fault in it is an error of the C++ build that says the script's own line.
/// `Source` is a ScriptSource and `Peers` a ScriptReach, constexpr variables at namespace scope.
template <const auto& Source, const auto& Peers>
inline constexpr const ScriptUnit& compiled_script = script_detail::CheckedScript<Source, Peers>::unit;

/// What is wrong with a constant script, for who wants to know and not to stop.
template <const auto& Source, const auto& Peers>
inline constexpr const Sentence& script_fault_of = script_detail::measured<Source, Peers>.fault;

} // namespace tappet
