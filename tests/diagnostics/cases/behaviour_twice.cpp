// A component has two behaviours.
// refused: loom: behaviour of "weft" stands in behaviours(...) twice; a component has one behaviour: remove one
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = loom(good_components, good_activities, good_connections, good_reactions,
                            behaviours(behaviour("weft", weft_cycle), behaviour("weft", weft_cycle)));
template struct tappet::Firmware<table, good_board>;
