// A program of a state machine may throw.
// refused by name: a program or guard of a state machine is a member function without arguments
#include "kernel/machine/table/compiled.hpp"
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

struct Gate {
    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    void shut() {}
    bool may_end() noexcept TAPPET_REALTIME { return true; }
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};
constexpr auto gate_cycle = state_machine<Gate>(
    "gate_cycle", states(state("shut", initial, entry<&Gate::shut>), state("safe", final)),
    transitions(transition("shut", "safe", guard<&Gate::may_end>)));
constexpr auto table =
    machine("yard", components(component<Gate>("gate")),
            activities(activity("gate", every(1ms), runs("gate"), budget(30us))), connections(), reactions(),
            behaviours(behaviour("gate", compiled<gate_cycle>)));
template struct tappet::Firmware<table, good_board>;
