// Behaviour rows that run native code:
//     behaviour("weft", compiled<weft_script>)     a script, compiled with the firmware
//     behaviour("loom", compiled<loom_cycle>)      a state machine table
//     behaviour("weft", compiled<weft_script>, slot(...))  the same, until another one is loaded
// Both are variables at namespace scope. Tables that the native code has folded in are not stored a second
// time.
#pragma once

#include "kernel/machine/table/behaviours.hpp"
#include "kernel/program/orders.hpp"
#include "kernel/script/native.hpp"

#include <array>
#include <utility>

namespace tappet {

/// A script or a table with its native code; a view.
struct CompiledBehaviour {
    const ScriptUnit* script = nullptr; ///< null: a table
    BehaviourType type{};
    std::span<const BehaviourCode> code{};
};

namespace native {

/// The most transitions of a state machine that is folded completely. Above it only programs and guards are
/// native, and the states stay in memory: folding them would double the C++ compiler's time for the machine.
inline constexpr std::size_t most_folded_transitions = 128;

/// A script without its instructions, and its native code.
template <const auto& source> struct CompiledUnit {
    static constexpr std::size_t count = source.types.size();
    using Numbers = std::make_index_sequence<count>;

    template <std::size_t type>
    static constexpr auto orders =
        copy_orders<count_orders(source.types[type].tables)>(source.types[type].tables);
    template <std::size_t type> static constexpr BehaviourType type_without_code() {
        BehaviourType row = source.types[type];
        row.orders = orders<type>;
#ifndef TAPPET_KEEPS_INSTRUCTIONS // of a program that draws the machine
        row.tables = native_tables<source, type>;
        row.machine.programs = &native_tables<source, type>;
#endif
        return row;
    }
    template <std::size_t type> static constexpr BehaviourCode code_of() {
        if constexpr (source.types[type].is_program())
            return {native_code<source, type>, {}};
        else if constexpr (source.types[type].machine.transitions.size() > most_folded_transitions)
            return {native_code<source, type>, {.capture = &MachineRows<source, type>::capture}};
        else
            return {native_code<source, type>, native_machine<source, type>};
    }
    template <std::size_t... type>
    static constexpr std::array<BehaviourType, count> all_types(std::index_sequence<type...>) {
        return {type_without_code<type>()...};
    }
    template <std::size_t... type>
    static constexpr std::array<BehaviourCode, count> all_code(std::index_sequence<type...>) {
        return {code_of<type>()...};
    }
    static constexpr auto types = all_types(Numbers{});
    static constexpr auto code = all_code(Numbers{});
    static constexpr ScriptUnit unit = [] {
        ScriptUnit copy = source;
        copy.types = types;
        return copy;
    }();
};

template <const auto& source> inline constexpr std::array table_code{
    BehaviourCode{{}, native_machine<source>}};

template <const auto& source> constexpr CompiledBehaviour compile() noexcept {
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(source)>, ScriptUnit>) {
        return {.script = &CompiledUnit<source>::unit, .code = CompiledUnit<source>::code};
    } else {
        const StateMachineTable machine = machine_of(source, 0);
        return {.type = {.name = machine.name, .machine = machine}, .code = table_code<source>};
    }
}

} // namespace native

/// `source`: a ScriptUnit, as compiled_script returns it, or a StateMachine of kernel/statechart/rows.hpp.
template <const auto& source> inline constexpr CompiledBehaviour compiled = native::compile<source>();

template <class... Options>
constexpr BehaviourRow behaviour(std::string_view component, const CompiledBehaviour& compiled,
                                 const Options&... options) noexcept {
    BehaviourRow row;
    row.component = component;
    row.script = compiled.script;
    row.type = compiled.type;
    row.instance.name = compiled.type.name;
    row.code = compiled.code;
    (detail::apply(row, options), ...);
    return row;
}

} // namespace tappet
