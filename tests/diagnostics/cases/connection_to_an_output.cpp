// A connection's second end is an output.
// refused: loom: connection "encoder.angle" -> "tension.torque": "tension.torque" is an output, not an input; name an input second
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table =
    loom(good_components, good_activities,
         connections(data("encoder.angle", "shaft.measured", stale_after(4ms), hold),
                     data("shaft.speed", "tension.speed"), data("encoder.angle", "tension.torque")),
         good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
