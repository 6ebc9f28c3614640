// A watchdog watches an activity that runs only when there is work.
// refused: loom: component "dog" watches activity "logic", which runs only when there is work; watch an output that it must write
#include "tests/diagnostics/guarded.hpp"

using namespace small;

constexpr auto table = loom(components_with(component<Watchdog>("dog", watches("logic"), set("limit", 20ms))),
                            dog_in_the_kennel, good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
