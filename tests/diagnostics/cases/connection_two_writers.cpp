// Two rows write one input.
// refused: loom: connection "weft.reference" -> "shaft.reference": "shaft.reference" is written by "tension.torque" already; an input has one writer: remove one row, or use a buffer
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table =
    loom(good_components, good_activities,
         connections(data("encoder.angle", "shaft.measured", stale_after(4ms), hold),
                     data("shaft.speed", "tension.speed"), data("tension.torque", "shaft.reference"),
                     data("weft.reference", "shaft.reference")),
         good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
