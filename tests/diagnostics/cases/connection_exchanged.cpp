// A connection runs from an input to an output.
// refused: loom: connection "shaft.measured" -> "encoder.angle" runs from an input to an output; exchange the two
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table =
    loom(good_components, good_activities,
         connections(data("shaft.measured", "encoder.angle"), data("shaft.speed", "tension.speed")),
         good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
