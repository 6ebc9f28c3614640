// A component's output feeds its own input.
// refused: loom: connection "shaft.speed" -> "shaft.reference": a component's own output feeds its own input; add delayed, or keep the value in the component
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table =
    loom(good_components, good_activities,
         connections(data("encoder.angle", "shaft.measured", stale_after(4ms), hold),
                     data("shaft.speed", "tension.speed"), data("shaft.speed", "shaft.reference")),
         good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
