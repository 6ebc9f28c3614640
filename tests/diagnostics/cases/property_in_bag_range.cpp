// A property in a bag is set outside its range.
// refused: loom: component "shaft" sets property "angles.window.high" to 361, which is over its greatest value 360; set a value in its range, or widen range(...) in the interface of small::Shaft
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table =
    loom(components(component<Encoder>("encoder", device("main_encoder")),
                    component<Shaft>("shaft", set("angles.window.high", 361)), component<Tension>("tension"),
                    component<Weft>("weft"), component<Climate>("climate", device("hall")),
                    component<Lamps>("lamps", device("panel"))),
         good_activities, good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
