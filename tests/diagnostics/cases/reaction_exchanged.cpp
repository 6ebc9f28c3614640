// A reaction has its two ends exchanged.
// refused: loom: reaction "tension.pre_tension" -> "shaft.window" runs from an operation to an event; exchange the two
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = loom(good_components, good_activities, good_connections,
                            reactions(when("encoder.index", tell("shaft.on_index")),
                                      when("tension.pre_tension", call("shaft.window"))),
                            good_behaviours);
template struct tappet::Firmware<table, good_board>;
