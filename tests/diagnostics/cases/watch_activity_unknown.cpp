// A watchdog watches an activity whose name is misspelt.
// refused: loom: component "dog" watches "moton", which no activity is called; did you mean "motion"?
#include "tests/diagnostics/guarded.hpp"

using namespace small;

constexpr auto table = loom(components_with(component<Watchdog>("dog", watches("moton"), set("limit", 20ms))),
                            dog_in_the_kennel, good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
