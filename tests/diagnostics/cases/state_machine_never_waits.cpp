// Transitions that need nothing form a ring.
// refused: loom: behaviour of "weft": state machine "faulty_cycle": state "idle" comes back to itself without waiting, by transition 2 ("weaving" to "idle"); give one transition of the ring on(...), after(...) or guard<>
#include "tests/diagnostics/small_machine.hpp"

using namespace small;
constexpr auto faulty_cycle = state_machine<Weft>(
    "faulty_cycle", states(state("idle", initial), state("weaving"), state("safe", final)),
    transitions(transition("idle", "weaving"), transition("weaving", "idle")));

constexpr auto table = loom(good_components, good_activities, good_connections, good_reactions,
                            behaviours(behaviour("weft", faulty_cycle)));
template struct tappet::Firmware<table, good_board, good_binding>;
