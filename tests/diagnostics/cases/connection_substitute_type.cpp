// The constant that stands in for a stale value is of another type than the port.
// refused: loom: connection "encoder.angle" -> "shaft.measured": substitute gives a value of type int, but "shaft.measured" is of type double; name a constant of the port's type
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr int at_rest = 0;
constexpr auto table =
    loom(good_components, good_activities,
         connections(data("encoder.angle", "shaft.measured", stale_after(4ms), substitute<at_rest>()),
                     data("shaft.speed", "tension.speed"), data("weft.reference", "shaft.reference")),
         good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
