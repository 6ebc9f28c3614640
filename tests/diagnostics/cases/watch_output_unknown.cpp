// A watchdog watches an output whose name is misspelt.
// refused: loom: component "dog" watches "encoder.angel": component "encoder" has no output "angel"; did you mean "angle"?
#include "tests/diagnostics/guarded.hpp"

using namespace small;

constexpr auto table =
    loom(components_with(component<Watchdog>("dog", watches("encoder.angel"), set("limit", 20ms))),
         dog_in_the_kennel, good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
