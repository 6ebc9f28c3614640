// A transition waits for an operation.
// refused: loom: behaviour of "weft": state machine "faulty_cycle": transition 1 ("idle" to "weaving" on "shaft.clear"): "shaft.clear" is an operation, not an event; name an event in on(...)
#include "tests/diagnostics/small_machine.hpp"

using namespace small;
constexpr auto faulty_cycle = state_machine<Weft>(
    "faulty_cycle", states(state("idle", initial), state("weaving"), state("safe", final)),
    transitions(transition("idle", "weaving", on("shaft.clear")),
                transition("weaving", "safe", on("broken"))));

constexpr auto table = loom(good_components, good_activities, good_connections, good_reactions,
                            behaviours(behaviour("weft", faulty_cycle)));
template struct tappet::Firmware<table, good_board>;
