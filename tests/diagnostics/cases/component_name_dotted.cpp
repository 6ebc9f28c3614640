// A component's name has a dot, which separates component and facet.
// refused: loom: component "main.shaft": a component's name is not empty and has no dot; rename it
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = loom(components(component<Encoder>("encoder", device("main_encoder")),
                                       component<Shaft>("main.shaft"), component<Tension>("tension"),
                                       component<Weft>("weft"), component<Climate>("climate", device("hall")),
                                       component<Lamps>("lamps", device("panel"))),
                            good_activities, good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
