// A synchronous call of a component that may block.
// refused: loom: reaction "weft.broken" -> "climate.log": component "climate" may block; use tell(...)
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table =
    loom(good_components, good_activities, good_connections,
         reactions(when("encoder.index", tell("shaft.on_index")), when("weft.broken", call("climate.log"))),
         good_behaviours);
template struct tappet::Firmware<table, good_board>;
