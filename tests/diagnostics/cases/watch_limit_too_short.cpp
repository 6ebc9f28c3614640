// A watchdog gives an activity less time than its period.
// refused: loom: component "dog" watches activity "hall" with a limit of 200000 us, not longer than its period of 250000 us; lengthen the limit
#include "tests/diagnostics/guarded.hpp"

using namespace small;

constexpr auto table = loom(components_with(component<Watchdog>("dog", watches("hall"), set("limit", 200ms))),
                            dog_in_the_kennel, good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
