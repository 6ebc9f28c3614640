// One row stands twice.
// refused: loom: connection "shaft.speed" -> "tension.speed" stands in connections(...) twice (rows 2 and 3); remove one
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table =
    loom(good_components, good_activities,
         connections(data("encoder.angle", "shaft.measured", stale_after(4ms), hold),
                     data("shaft.speed", "tension.speed"), data("shaft.speed", "tension.speed")),
         good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
