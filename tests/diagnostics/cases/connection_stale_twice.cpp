// A row says two things about a stale value.
// refused: loom: connection "encoder.angle" -> "shaft.measured" says more than once what a stale value means; keep one of hold, substitute and stop_machine
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table =
    loom(good_components, good_activities,
         connections(data("encoder.angle", "shaft.measured", stale_after(4ms), substitute(0), stop_machine),
                     data("shaft.speed", "tension.speed"), data("weft.reference", "shaft.reference")),
         good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
