// A watchdog watches an output that reaches no other activity.
// refused: loom: component "dog" watches "shaft.speed", which no connection leads to another activity; connect it there, or watch activity "motion"
#include "tests/diagnostics/guarded.hpp"

using namespace small;

constexpr auto table =
    loom(components_with(component<Watchdog>("dog", watches("shaft.speed"), set("limit", 20ms))),
         dog_in_the_kennel, good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
