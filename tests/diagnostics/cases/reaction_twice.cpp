// One reaction stands twice.
// refused: loom: reaction "weft.broken" -> "shaft.clear" stands in reactions(...) twice (rows 2 and 4); remove one
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table =
    loom(good_components, good_activities, good_connections,
         reactions(when("encoder.index", tell("shaft.on_index")), when("weft.broken", tell("shaft.clear")),
                   when("weft.broken", call("tension.relax")), when("weft.broken", tell("shaft.clear"))),
         good_behaviours);
template struct tappet::Firmware<table, good_board>;
