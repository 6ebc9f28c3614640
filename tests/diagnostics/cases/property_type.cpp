// A property is set to a value of another type.
// refused: loom: component "shaft" sets property "reversed" to 2.5, but it is true or false; write true or false
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table =
    loom(components(component<Encoder>("encoder", device("main_encoder")),
                    component<Shaft>("shaft", set("reversed", 2.5)), component<Tension>("tension"),
                    component<Weft>("weft"), component<Climate>("climate", device("hall")),
                    component<Lamps>("lamps", device("panel"))),
         good_activities, good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
