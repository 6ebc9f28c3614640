// The binding says nothing of a device of that name.
// refused: loom: component "encoder": the binding to board "bench" does not say where device "main_encodr" stands; did you mean "main_encoder"?
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = loom(components(component<Encoder>("encoder", device("main_encodr")),
                                       component<Shaft>("shaft"), component<Tension>("tension"),
                                       component<Weft>("weft"), component<Climate>("climate", device("hall")),
                                       component<Lamps>("lamps", device("panel"))),
                            good_activities, good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board, good_binding>;
