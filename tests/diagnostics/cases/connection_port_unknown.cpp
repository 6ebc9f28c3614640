// A connection names a port that is misspelt.
// refused: loom: connection "encoder.angle" -> "shaft.mesured": component "shaft" has no input "mesured"; did you mean "measured"?
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = loom(good_components, good_activities,
                            connections(data("encoder.angle", "shaft.mesured", stale_after(4ms), hold),
                                        data("shaft.speed", "tension.speed")),
                            good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
