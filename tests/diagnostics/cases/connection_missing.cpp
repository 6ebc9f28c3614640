// A required input is not connected.
// refused: loom: component "tension": its required input "speed" is not connected; add data("...", "tension.speed")
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = loom(good_components, good_activities,
                            connections(data("encoder.angle", "shaft.measured", stale_after(4ms), hold)),
                            good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
