// A connection names a component that is nothing like one of the table.
// refused: loom: connection "gearbox.angle" -> "shaft.measured": there is no component "gearbox"; add it to components(...)
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = loom(good_components, good_activities,
                            connections(data("gearbox.angle", "shaft.measured", stale_after(4ms), hold),
                                        data("shaft.speed", "tension.speed")),
                            good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
