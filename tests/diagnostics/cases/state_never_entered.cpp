// No transition leads to a state.
// refused: loom: behaviour of "weft": state machine "faulty_cycle": state "washing" is never entered; lead a transition to it, make it initial, or drop it
#include "tests/diagnostics/small_machine.hpp"

using namespace small;
constexpr auto faulty_cycle = state_machine<Weft>(
    "faulty_cycle", states(state("idle", initial), state("weaving"), state("safe", final), state("washing")),
    transitions(transition("idle", "weaving", on("shaft.window")),
                transition("weaving", "safe", on("broken")), transition("washing", "idle", after(2s))));

constexpr auto table = loom(good_components, good_activities, good_connections, good_reactions,
                            behaviours(behaviour("weft", faulty_cycle)));
template struct tappet::Firmware<table, good_board>;
