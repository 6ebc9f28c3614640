// A guard of a state machine is not declared TAPPET_REALTIME.
// refused by clang: Member<bool (Gate::*)() noexcept>::real_time
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

struct Gate {
    bool may_pass() noexcept { return true; }
};
constexpr auto gate_cycle =
    state_machine<Gate>("gate_cycle", states(state("shut", initial), state("safe", final)),
                        transitions(transition("shut", "safe", guard<&Gate::may_pass>)));
