// A watchdog watches an activity and does not say for how long it may be silent.
// refused: loom: component "dog" watches activity "motion" without a limit; add set("limit", ...) longer than its period
#include "tests/diagnostics/guarded.hpp"

using namespace small;

constexpr auto table = loom(components_with(component<Watchdog>("dog", watches("motion"))), dog_in_the_kennel,
                            good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
