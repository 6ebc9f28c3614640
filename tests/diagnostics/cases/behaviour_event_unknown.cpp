// A transition waits for an event that is misspelt.
// refused: loom: behaviour of "weft": state machine "faulty_cycle": transition 2 ("weaving" to "safe" on "brokn"): component "weft" has no event "brokn"; did you mean "broken"?
#include "tests/diagnostics/small_machine.hpp"

using namespace small;
constexpr auto faulty_cycle = state_machine<Weft>(
    "faulty_cycle", states(state("idle", initial), state("weaving"), state("safe", final)),
    transitions(transition("idle", "weaving", on("shaft.window")),
                transition("weaving", "safe", on("brokn"))));

constexpr auto table = loom(good_components, good_activities, good_connections, good_reactions,
                            behaviours(behaviour("weft", faulty_cycle)));
template struct tappet::Firmware<table, good_board, good_binding>;
