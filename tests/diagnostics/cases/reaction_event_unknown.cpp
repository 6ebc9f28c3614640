// A reaction names an event that is misspelt.
// refused: loom: reaction "shaft.windwo" -> "tension.pre_tension": component "shaft" has no event "windwo"; did you mean "window"?
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = loom(good_components, good_activities, good_connections,
                            reactions(when("encoder.index", tell("shaft.on_index")),
                                      when("shaft.windwo", call("tension.pre_tension"))),
                            good_behaviours);
template struct tappet::Firmware<table, good_board>;
