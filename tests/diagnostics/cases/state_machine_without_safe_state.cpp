// No state is final.
// refused: loom: behaviour of "weft": state machine "faulty_cycle": no state is final; mark the safe state that the machine may be brought to from everywhere
#include "tests/diagnostics/small_machine.hpp"

using namespace small;
constexpr auto faulty_cycle =
    state_machine<Weft>("faulty_cycle", states(state("idle", initial), state("weaving")),
                        transitions(transition("idle", "weaving", on("shaft.window")),
                                    transition("weaving", "idle", on("broken"))));

constexpr auto table = loom(good_components, good_activities, good_connections, good_reactions,
                            behaviours(behaviour("weft", faulty_cycle)));
template struct tappet::Firmware<table, good_board>;
