// A transition waits for another component's event that is misspelt.
// refused: loom: behaviour of "weft": state machine "faulty_cycle": transition 1 ("idle" to "weaving" on "shaft.windw"): component "shaft" has no event "windw"; did you mean "window"?
#include "tests/diagnostics/small_machine.hpp"

using namespace small;
constexpr auto faulty_cycle = state_machine<Weft>(
    "faulty_cycle", states(state("idle", initial), state("weaving"), state("safe", final)),
    transitions(transition("idle", "weaving", on("shaft.windw")),
                transition("weaving", "safe", on("broken"))));

constexpr auto table = loom(good_components, good_activities, good_connections, good_reactions,
                            behaviours(behaviour("weft", faulty_cycle)));
template struct tappet::Firmware<table, good_board>;
