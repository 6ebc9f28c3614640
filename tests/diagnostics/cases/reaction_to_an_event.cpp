// A reaction's operation is an event.
// refused: loom: reaction "shaft.window" -> "weft.broken": "weft.broken" is an event, not an operation; name an operation second
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table =
    loom(good_components, good_activities, good_connections,
         reactions(when("encoder.index", tell("shaft.on_index")), when("shaft.window", tell("weft.broken"))),
         good_behaviours);
template struct tappet::Firmware<table, good_board>;
