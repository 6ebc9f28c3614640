// A state machine does not say where it begins.
// refused: axis.osd:2:14: state machine "M": no top state is initial; mark the one to start in
#include "tests/diagnostics/script_case.hpp"

inline constexpr tappet::ScriptSource source{"axis.osd", R"(
StateMachine M {
    state A { transition mark select Z }
    final state Z { }
}
RootStateMachine M m
)"};
constexpr const tappet::ScriptUnit& unit = tappet::compiled_script<source, axis_reach>;
