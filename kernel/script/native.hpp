// Native code of a script compiled with the firmware: each of its programs and state machines is machine
// code; nothing is interpreted.
#pragma once

#include "kernel/script/unit.hpp"
#include "kernel/statechart/native.hpp"

namespace tappet {

constexpr const ProgramTables& tables_of(const ScriptUnit& unit, std::size_t type) noexcept {
    return unit.types[type].tables;
}
constexpr StateMachineTable machine_of(const ScriptUnit& unit, std::size_t type) noexcept {
    return unit.types[type].machine;
}

} // namespace tappet
