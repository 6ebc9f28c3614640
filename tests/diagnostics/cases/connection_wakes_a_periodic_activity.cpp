// wakes stands on a row into a periodic activity.
// refused: loom: connection "encoder.angle" -> "shaft.measured" wakes activity "motion", which is periodic; remove wakes
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table =
    loom(good_components, good_activities,
         connections(data("encoder.angle", "shaft.measured", wakes), data("shaft.speed", "tension.speed")),
         good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
