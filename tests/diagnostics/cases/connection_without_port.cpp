// A connection names a component alone.
// refused: loom: connection "shaft" -> "tension.speed": "shaft" is not of the form "component.output"; name both
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = loom(good_components, good_activities,
                            connections(data("encoder.angle", "shaft.measured", stale_after(4ms), hold),
                                        data("shaft", "tension.speed")),
                            good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
