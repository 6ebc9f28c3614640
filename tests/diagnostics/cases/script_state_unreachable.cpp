// No transition leads to a state.
// refused: axis.osd:4:5: state machine "M": state "B" is never entered; lead a transition to it, make it initial, or drop it
#include "tests/diagnostics/script_case.hpp"

inline constexpr tappet::ScriptSource source{"axis.osd", R"(
StateMachine M {
    initial state A { transition mark select Z }
    state B { transition mark select Z }
    final state Z { }
}
RootStateMachine M m
)"};
constexpr const tappet::ScriptUnit& unit = tappet::compiled_script<source, axis_reach>;
