// A component that is no watchdog watches.
// refused: loom: component "dog" is no watchdog; remove watches("motion")
#include "tests/diagnostics/guarded.hpp"

using namespace small;

constexpr auto table = loom(components_with(component<TimedEvent>("dog", watches("motion"))),
                            dog_in_the_kennel, good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
