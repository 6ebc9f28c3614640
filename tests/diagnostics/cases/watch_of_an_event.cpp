// A watchdog watches an event.
// refused: loom: component "dog" watches "weft.broken", which is an event; name an activity, or an output of last values
#include "tests/diagnostics/guarded.hpp"

using namespace small;

constexpr auto table =
    loom(components_with(component<Watchdog>("dog", watches("weft.broken"), set("limit", 20ms))),
         dog_in_the_kennel, good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
