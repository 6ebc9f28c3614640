// A reaction's event is a port.
// refused: loom: reaction "shaft.speed" -> "tension.pre_tension": "shaft.speed" is an output, not an event; name an event first
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = loom(good_components, good_activities, good_connections,
                            reactions(when("encoder.index", tell("shaft.on_index")),
                                      when("shaft.speed", call("tension.pre_tension"))),
                            good_behaviours);
template struct tappet::Firmware<table, good_board>;
