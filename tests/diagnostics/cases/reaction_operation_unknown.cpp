// A reaction names an operation that is misspelt.
// refused: loom: reaction "shaft.window" -> "tension.pretension": component "tension" has no operation "pretension"; did you mean "pre_tension"?
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = loom(good_components, good_activities, good_connections,
                            reactions(when("encoder.index", tell("shaft.on_index")),
                                      when("shaft.window", call("tension.pretension"))),
                            good_behaviours);
template struct tappet::Firmware<table, good_board>;
