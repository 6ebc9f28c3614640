// A property that is a time is set to a bare number.
// refused: loom: component "shaft" sets property "filter" to 2, but it is a time; write it with its unit, like 2ms
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table =
    loom(components(component<Encoder>("encoder", device("main_encoder")),
                    component<Shaft>("shaft", set("filter", 2)), component<Tension>("tension"),
                    component<Weft>("weft"), component<Climate>("climate", device("hall")),
                    component<Lamps>("lamps", device("panel"))),
         good_activities, good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
