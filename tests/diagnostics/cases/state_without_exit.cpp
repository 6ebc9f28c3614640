// A state has no way out.
// refused: loom: behaviour of "weft": state machine "faulty_cycle": state "weaving" has no way out; give it a transition, or mark it final
#include "tests/diagnostics/small_machine.hpp"

using namespace small;
constexpr auto faulty_cycle = state_machine<Weft>(
    "faulty_cycle", states(state("idle", initial), state("weaving"), state("safe", final)),
    transitions(transition("idle", "weaving", on("shaft.window"))));

constexpr auto table = loom(good_components, good_activities, good_connections, good_reactions,
                            behaviours(behaviour("weft", faulty_cycle)));
template struct tappet::Firmware<table, good_board>;
