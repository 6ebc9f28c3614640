// A connection's first end is an input.
// refused: loom: connection "tension.speed" -> "shaft.reference": "tension.speed" is an input, not an output; name an output first
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table =
    loom(good_components, good_activities,
         connections(data("encoder.angle", "shaft.measured", stale_after(4ms), hold),
                     data("shaft.speed", "tension.speed"), data("tension.speed", "shaft.reference")),
         good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
