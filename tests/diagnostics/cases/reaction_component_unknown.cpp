// A reaction names a component that is misspelt.
// refused: loom: reaction "shaft.window" -> "tenison.pre_tension": there is no component "tenison"; did you mean "tension"?
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = loom(good_components, good_activities, good_connections,
                            reactions(when("encoder.index", tell("shaft.on_index")),
                                      when("shaft.window", call("tenison.pre_tension"))),
                            good_behaviours);
template struct tappet::Firmware<table, good_board>;
