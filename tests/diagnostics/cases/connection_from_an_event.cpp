// A connection's first end is an event.
// refused: loom: connection "weft.broken" -> "shaft.reference": "weft.broken" is an event, not an output; name an output first
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table =
    loom(good_components, good_activities,
         connections(data("encoder.angle", "shaft.measured", stale_after(4ms), hold),
                     data("shaft.speed", "tension.speed"), data("weft.broken", "shaft.reference")),
         good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
