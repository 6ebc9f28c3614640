// A component that drives nothing is given a device.
// refused: loom: component "shaft" drives no device; remove device("main_encoder")
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table =
    loom(components(component<Encoder>("encoder", device("main_encoder")),
                    component<Shaft>("shaft", device("main_encoder")), component<Tension>("tension"),
                    component<Weft>("weft"), component<Climate>("climate", device("hall")),
                    component<Lamps>("lamps", device("panel"))),
         good_activities, good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
