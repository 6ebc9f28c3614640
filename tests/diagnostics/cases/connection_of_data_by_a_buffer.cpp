// buffer(...) names a port of single values.
// refused: loom: connection "encoder.angle" -> "shaft.measured": "encoder.angle" is an output, not a buffered output; write data(...)
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table =
    loom(good_components, good_activities,
         connections(buffer<4>("encoder.angle", "shaft.measured"), data("shaft.speed", "tension.speed")),
         good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
