// An entry program of a state machine takes a lock.
// refused by clang: must not call non-'nonblocking' function 'std::mutex::lock'
#include "tests/diagnostics/small_machine.hpp"

#include <mutex>

using namespace small;

struct Gate {
    std::mutex door;
    void shut() noexcept TAPPET_REALTIME { door.lock(); }
};
constexpr auto gate_cycle = state_machine<Gate>(
    "gate_cycle", states(state("shut", initial, entry<&Gate::shut>), state("safe", final)),
    transitions(transition("shut", "safe", on("gate.close"))));
