// A connection names a port that is nothing like one of the component.
// refused: loom: connection "shaft.oil_pressure" -> "tension.speed": component "shaft" has no output "oil_pressure"; add it to the component's interface
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = loom(good_components, good_activities,
                            connections(data("encoder.angle", "shaft.measured", stale_after(4ms), hold),
                                        data("shaft.oil_pressure", "tension.speed")),
                            good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
