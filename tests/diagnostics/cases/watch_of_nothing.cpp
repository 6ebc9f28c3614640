// A watchdog watches nothing.
// refused: loom: component "dog" watches nothing; add watches("...") with an activity or an output
#include "tests/diagnostics/guarded.hpp"

using namespace small;

constexpr auto table = loom(components_with(component<Watchdog>("dog")), dog_in_the_kennel, good_connections,
                            good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
