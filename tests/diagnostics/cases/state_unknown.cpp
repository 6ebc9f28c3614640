// A transition leads to a state that is misspelt.
// refused: loom: behaviour of "weft": state machine "faulty_cycle": transition 1 ("idle" to "weavng" on "shaft.window") leads to an unknown state "weavng"; did you mean "weaving"?
#include "tests/diagnostics/small_machine.hpp"

using namespace small;
constexpr auto faulty_cycle = state_machine<Weft>(
    "faulty_cycle", states(state("idle", initial), state("weaving"), state("safe", final)),
    transitions(transition("idle", "weavng", on("shaft.window")),
                transition("weaving", "safe", on("broken"))));

constexpr auto table = loom(good_components, good_activities, good_connections, good_reactions,
                            behaviours(behaviour("weft", faulty_cycle)));
template struct tappet::Firmware<table, good_board>;
