// A property is set twice.
// refused: loom: component "shaft" sets property "gain" twice; keep one
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = loom(components(component<Encoder>("encoder", device("main_encoder")),
                                       component<Shaft>("shaft", set("gain", 2.0), set("gain", 3.0)),
                                       component<Tension>("tension"), component<Weft>("weft"),
                                       component<Climate>("climate", device("hall")),
                                       component<Lamps>("lamps", device("panel"))),
                            good_activities, good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
