// The board's device is of another kind.
// refused: loom: component "encoder" drives a can device but "panel" of board "bench" is of kind gpio; name another
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = loom(components(component<Encoder>("encoder", device("panel")),
                                       component<Shaft>("shaft"), component<Tension>("tension"),
                                       component<Weft>("weft"), component<Climate>("climate", device("hall")),
                                       component<Lamps>("lamps", device("panel"))),
                            good_activities, good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
