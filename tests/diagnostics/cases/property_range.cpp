// A property is set outside its range.
// refused: loom: component "shaft" sets property "gain" to 12.5, which is over its greatest value 10; set a value in its range, or widen range(...) in the interface of small::Shaft
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table =
    loom(components(component<Encoder>("encoder", device("main_encoder")),
                    component<Shaft>("shaft", set("gain", 12.5)), component<Tension>("tension"),
                    component<Weft>("weft"), component<Climate>("climate", device("hall")),
                    component<Lamps>("lamps", device("panel"))),
         good_activities, good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
