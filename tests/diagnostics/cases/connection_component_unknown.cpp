// A connection names a component that is misspelt.
// refused: loom: connection "encodr.angle" -> "shaft.measured": there is no component "encodr"; did you mean "encoder"?
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = loom(good_components, good_activities,
                            connections(data("encodr.angle", "shaft.measured", stale_after(4ms), hold),
                                        data("shaft.speed", "tension.speed")),
                            good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
