// A driver's row names no device.
// refused: loom: component "encoder" drives a can device but its row names none; add device("...")
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table =
    loom(components(component<Encoder>("encoder"), component<Shaft>("shaft"), component<Tension>("tension"),
                    component<Weft>("weft"), component<Climate>("climate", device("hall")),
                    component<Lamps>("lamps", device("panel"))),
         good_activities, good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
