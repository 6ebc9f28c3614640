// A state is entered and never left.
// refused: axis.osd:4:5: state machine "M": state "B" has no way out; give it a transition, or mark it final
#include "tests/diagnostics/script_case.hpp"

inline constexpr tappet::ScriptSource source{"axis.osd", R"(
StateMachine M {
    initial state A { transition mark select B }
    state B { run { do home(1); } }
    final state Z { }
}
RootStateMachine M m
)"};
constexpr const tappet::ScriptUnit& unit = tappet::compiled_script<source, axis_reach>;
