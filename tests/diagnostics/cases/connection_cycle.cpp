// The data flow of an activity closes a ring.
// refused: loom: connection "tension.torque" -> "shaft.reference" closes a data-flow cycle inside activity "motion" (shaft -> tension -> shaft); add delayed to the row whose reader may use the last cycle's value
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table =
    loom(good_components, good_activities,
         connections(data("encoder.angle", "shaft.measured", stale_after(4ms), hold),
                     data("shaft.speed", "tension.speed"), data("tension.torque", "shaft.reference")),
         good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board, good_binding>;
