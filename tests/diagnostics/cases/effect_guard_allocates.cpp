// A guard of a state machine allocates.
// refused by clang: must not call non-'nonblocking' function 'std::vector<int>::push_back'
#include "tests/diagnostics/small_machine.hpp"

#include <vector>

using namespace small;

struct Gate {
    std::vector<int> seen;
    bool may_pass() noexcept TAPPET_REALTIME {
        seen.push_back(1);
        return true;
    }
};
constexpr auto gate_cycle =
    state_machine<Gate>("gate_cycle", states(state("shut", initial), state("safe", final)),
                        transitions(transition("shut", "safe", guard<&Gate::may_pass>)));
