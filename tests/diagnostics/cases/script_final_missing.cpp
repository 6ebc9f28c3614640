// A state machine has no safe state.
// refused: axis.osd:2:14: state machine "M": no state is final; mark the safe state that the machine may be brought to from everywhere
#include "tests/diagnostics/script_case.hpp"

inline constexpr tappet::ScriptSource source{"axis.osd", R"(
StateMachine M {
    initial state A { transition mark select B }
    state B { transition mark select A }
}
RootStateMachine M m
)"};
constexpr const tappet::ScriptUnit& unit = tappet::compiled_script<source, axis_reach>;
