// delayed stands on a row between two activities.
// refused: loom: connection "encoder.angle" -> "shaft.measured": delayed means one cycle of one activity, but this row crosses from "field" to "motion"; remove delayed
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table =
    loom(good_components, good_activities,
         connections(data("encoder.angle", "shaft.measured", delayed), data("shaft.speed", "tension.speed")),
         good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
