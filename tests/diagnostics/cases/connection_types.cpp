// The two ends have different types.
// refused: loom: connection "encoder.turns" -> "shaft.measured": "encoder.turns" is of type int but "shaft.measured" is of type double; connect ports of one type
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table =
    loom(good_components, good_activities,
         connections(data("encoder.turns", "shaft.measured"), data("shaft.speed", "tension.speed")),
         good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
