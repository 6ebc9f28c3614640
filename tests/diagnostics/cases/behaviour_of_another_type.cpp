// A state machine is written for another component type.
// refused: loom: behaviour of "tension": state machine "weft_cycle" is written for small::Weft but "tension" is a small::Tension; name a component of its type
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = loom(good_components, good_activities, good_connections, good_reactions,
                            behaviours(behaviour("weft", weft_cycle), behaviour("tension", weft_cycle)));
template struct tappet::Firmware<table, good_board>;
