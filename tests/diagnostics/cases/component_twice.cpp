// Two rows of components(...) have one name.
// refused: loom: component "shaft" stands in components(...) twice (rows 2 and 7); rename or remove one
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table =
    loom(components(component<Encoder>("encoder", device("main_encoder")), component<Shaft>("shaft"),
                    component<Tension>("tension"), component<Weft>("weft"),
                    component<Climate>("climate", device("hall")), component<Lamps>("lamps", device("panel")),
                    component<Tension>("shaft")),
         good_activities, good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
