// A row of components(...) is misspelt; all the other rows are right.
// refused: loom: component "encodr" is named by no other row, but 4 rows name "encoder", which components(...) has not; rename it to that
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = loom(components(component<Encoder>("encodr", device("main_encoder")),
                                       component<Shaft>("shaft"), component<Tension>("tension"),
                                       component<Weft>("weft"), component<Climate>("climate", device("hall")),
                                       component<Lamps>("lamps", device("panel"))),
                            good_activities, good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board, good_binding>;
